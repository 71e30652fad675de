#include "core/study/scan_case.h"

#include <algorithm>

namespace skincal {
namespace {

struct Named {
    Disturbance disturbance;
    std::string_view name;
    std::vector<double> strengths;
};

const std::vector<Named>& disturbances() {
    static const std::vector<Named> all{
        {Disturbance::None, "none", {0}},
        {Disturbance::Ambient, "ambient", {0, 30, 120, 200, 240, 300}},
        {Disturbance::Reflection, "reflection", {0.1, 0.3, 0.5, 0.7, 0.9}},
        {Disturbance::Hidden, "hidden", {0.1, 0.3, 0.5, 0.7, 0.9}},
        {Disturbance::Screen, "screen", {20, 60, 120, 250}},
        {Disturbance::Mains50, "mains50", {10, 25, 50, 100}},
        {Disturbance::Mains60, "mains60", {10, 25, 50, 100}},
        {Disturbance::Sun, "sun", {0.1, 0.3, 1, 2}},
        {Disturbance::Person, "person", {1}},
        {Disturbance::Exposure, "exposure", {0.1, 0.3, 0.5, 0.7}},
        {Disturbance::Bump, "bump", {0.5, 2, 6, 20}},
        {Disturbance::Focus, "focus", {1.4, 1.8, 2.4, 3.4}},
        {Disturbance::Crowding, "crowding", {8, 6, 4, 3, 2}},
    };
    return all;
}

const Named& named(Disturbance disturbance) {
    return *std::find_if(disturbances().begin(), disturbances().end(),
                         [&](const Named& entry) { return entry.disturbance == disturbance; });
}

}  // namespace

std::string_view name(Disturbance disturbance) {
    return named(disturbance).name;
}

bool hasMirror(Disturbance disturbance) {
    return disturbance == Disturbance::Reflection || disturbance == Disturbance::Hidden;
}

std::optional<Disturbance> findDisturbance(std::string_view name) {
    for (const Named& entry : disturbances()) {
        if (entry.name == name)
            return entry.disturbance;
    }
    return std::nullopt;
}

const std::vector<double>& strengthsOf(Disturbance disturbance) {
    return named(disturbance).strengths;
}

std::string_view name(ScanMethod method) {
    switch (method) {
        case ScanMethod::Coded:
            return "coded";
        case ScanMethod::CodedOnce:
            return "coded once";
        case ScanMethod::OneAtATime:
            return "one at a time";
        case ScanMethod::PaperSingle:
            return "paper";
    }
    return "";
}

std::vector<ScanCase> allScanCases() {
    std::vector<ScanCase> cases;
    for (const Named& entry : disturbances()) {
        for (const double strength : entry.strengths) {
            for (const ScanMethod method : {ScanMethod::Coded, ScanMethod::OneAtATime, ScanMethod::PaperSingle})
                cases.push_back({entry.disturbance, strength, 55, 0.8, method});
        }
    }
    for (const std::size_t modules : {7, 200, 1000, 10'000}) {
        for (const double distance : {0.3, 0.8, 2.0})
            cases.push_back({Disturbance::None, 0, modules, distance, ScanMethod::Coded});
    }
    for (const Named& entry : disturbances()) {
        if (entry.disturbance == Disturbance::None || entry.disturbance == Disturbance::Crowding)
            continue;
        for (const std::size_t modules : {7, 1000}) {
            // One patch, turned to the mirror: nothing shows that there is one.
            if (entry.disturbance == Disturbance::Hidden && modules == 7)
                continue;
            cases.push_back(
                {entry.disturbance, entry.strengths[entry.strengths.size() / 2], modules, 0.8, ScanMethod::Coded});
        }
    }
    return cases;
}

}  // namespace skincal
