#include "core/estimation/body_model.h"

namespace skincal {

std::string_view name(Finding::Kind kind) {
    switch (kind) {
        case Finding::Kind::WrongLink:
            return "wrong link";
        case Finding::Kind::MovedModule:
            return "moved module";
        case Finding::Kind::MovedPatch:
            return "moved patch";
        case Finding::Kind::WrongTemplate:
            return "wrong template";
        case Finding::Kind::ShakenPose:
            return "shaken pose";
        case Finding::Kind::NoisyAccelerometer:
            return "noisy accelerometer";
        case Finding::Kind::BumpedView:
            return "bumped view";
        default:
            return "unsteady view";
    }
}

std::string_view name(Trust trust) {
    switch (trust) {
        case Trust::Good:
            return "good";
        case Trust::Usable:
            return "usable";
        default:
            return "not to be trusted";
    }
}

Sentence sentenceOf(Trust trust) {
    switch (trust) {
        case Trust::Good:
            return Sentence::saying("good");
        case Trust::Usable:
            return Sentence::saying("usable");
        default:
            return Sentence::saying("not to be trusted");
    }
}

}  // namespace skincal
