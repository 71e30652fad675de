#include "ui/presenters/board_words.h"

#include <QCoreApplication>
#include <algorithm>
#include <array>
#include <cmath>

namespace skincal {
namespace {

struct BoardWords {
    Q_DECLARE_TR_FUNCTIONS(BoardWords)
};

QString percent(double share) {
    return QString::number(100 * share, 'f', share < 0.01 ? 1 : 0);
}

QString fixed(double value, int decimals) {
    // A hyphen is hard to see before digits.
    return QString::number(value, 'f', decimals).replace(u'-', QChar(0x2212));
}

/// Both with as many decimals as show two digits of the standard deviation.
LensFigure figure(const QString& name, double value, std::optional<double> sigma, int decimals) {
    if (!sigma || !(*sigma > 0))
        return {name, fixed(value, decimals), {}};
    const int some = std::clamp(1 - static_cast<int>(std::floor(std::log10(*sigma))), 0, 6);
    return {name, fixed(value, some), fixed(*sigma, some)};
}

}  // namespace

QString planFault(const BoardPlan& plan) {
    if (plan.validate())
        return {};
    BoardPlan chess = plan;
    chess.kind = BoardKind::Chessboard;
    if (!chess.validate())
        return BoardWords::tr("A board has 3 to 40 squares each way, of 1 mm to 1 m.");
    if (plan.marker < 0.4 * plan.square || plan.marker > 0.9 * plan.square)
        return BoardWords::tr("Markers are between 0.4 and 0.9 of a square: %1 to %2 mm here.")
            .arg(400 * plan.square, 0, 'g', 4)
            .arg(900 * plan.square, 0, 'g', 4);
    return BoardWords::tr("The dictionary has %1 markers, this board needs %2.")
        .arg(markerCount(plan.dictionary))
        .arg(plan.columns * plan.rows / 2);
}

QString sentenceOf(const BoardFault& fault, const BoardPlan& plan) {
    switch (fault.miss) {
        case BoardMiss::TooFewCorners:
            return BoardWords::tr("Corners found: %1 of at least %2. Bring it into the picture, nearer or into focus.")
                .arg(fault.found)
                .arg(fault.needed);
        case BoardMiss::TooSmall:
            return BoardWords::tr("Too far away: squares of %1 pixels, %2 are needed.")
                .arg(fault.found, 0, 'f', 0)
                .arg(fault.needed, 0, 'f', 0);
        case BoardMiss::Blurred:
            return BoardWords::tr("Blurred by %1 pixels, %2 at most: hold still, focus, more light or less exposure.")
                .arg(fault.found, 0, 'f', 2)
                .arg(fault.needed, 0, 'f', 2);
        default:
            return plan.kind == BoardKind::Chessboard
                       ? BoardWords::tr("No such board in the picture: a chessboard must show as a whole.")
                       : BoardWords::tr("No such board in the picture.");
    }
}

QString sentenceOf(OfferOutcome outcome) {
    switch (outcome) {
        case OfferOutcome::Redundant:
            return BoardWords::tr("Too like one that was taken: move or tilt it.");
        case OfferOutcome::Moving:
            return BoardWords::tr("It moves: hold it still.");
        case OfferOutcome::OtherSize:
            return BoardWords::tr("The pictures have another size than those before: start over.");
        default:
            return BoardWords::tr("Taken.");
    }
}

QString sentenceOf(const MissingView& missing) {
    switch (missing.wish) {
        case BoardWish::LeftEdge:
            return BoardWords::tr("Show it at the left edge.");
        case BoardWish::RightEdge:
            return BoardWords::tr("Show it at the right edge.");
        case BoardWish::TopEdge:
            return BoardWords::tr("Show it at the upper edge.");
        case BoardWish::BottomEdge:
            return BoardWords::tr("Show it at the lower edge.");
        case BoardWish::Nearer:
            return BoardWords::tr("Bring it nearer: it should fill half the picture's width and height.");
        case BoardWish::Farther:
            return BoardWords::tr("Hold it farther away.");
        case BoardWish::Turn:
            return BoardWords::tr("Turn it: its left or right side nearer, by %1° or more.").arg(missing.need);
        case BoardWish::Tilt:
            return BoardWords::tr("Tilt it: its upper or lower side nearer, by %1° or more.").arg(missing.need);
        case BoardWish::FillCells:
            return BoardWords::tr("Show it where the map is empty: %1 % covered, %2 % wanted.")
                .arg(percent(missing.have), percent(missing.need));
        default:
            return BoardWords::tr("More boards: %1 of %2.").arg(missing.have).arg(missing.need);
    }
}

QString sentenceOf(const CalibrationReason& reason) {
    using Kind = CalibrationReason::Kind;
    switch (reason.kind) {
        case Kind::FewBoards:
            return BoardWords::tr("%n boards, better %1", nullptr, static_cast<int>(reason.found)).arg(reason.needed);
        case Kind::PoorCoverage:
            return BoardWords::tr("they cover %1 % of the picture, better %2 %")
                .arg(percent(reason.found), percent(reason.needed));
        case Kind::LittleTilt:
            return BoardWords::tr("boards differ in angle by %1° at most, better %2°")
                .arg(reason.found, 0, 'f', 0)
                .arg(reason.needed);
        case Kind::LargeResiduals:
            return BoardWords::tr("residuals of %1 px, better %2").arg(reason.found, 0, 'f', 2).arg(reason.needed);
        case Kind::FocalUncertain:
            return BoardWords::tr("the focal length is uncertain by %1 %, better %2 %")
                .arg(100 * reason.found, 0, 'f', 2)
                .arg(100 * reason.needed);
        case Kind::CentreUncertain:
            return BoardWords::tr("the centre is uncertain by %1 % of the width, better %2 %")
                .arg(100 * reason.found, 0, 'f', 2)
                .arg(100 * reason.needed);
        case Kind::ManyRejected:
            return BoardWords::tr("%1 % of the boards were left out").arg(percent(reason.found));
        case Kind::FoldsBack:
            return BoardWords::tr(
                       "the distortion folds back at %1 % of the way to the corners: boards are missing there")
                .arg(percent(reason.found));
        default:
            return BoardWords::tr("the boards leave the lens undetermined: tilt them more");
    }
}

QString sentenceOf(CalibrationTrust trust) {
    switch (trust) {
        case CalibrationTrust::Good:
            return BoardWords::tr("Good");
        case CalibrationTrust::Usable:
            return BoardWords::tr("Usable");
        default:
            return BoardWords::tr("Not to be trusted yet");
    }
}

QString sentenceOf(const CalibrationError& error) {
    switch (error.code) {
        case ErrorCode::TooFewPoses:
            return BoardWords::tr("Too few boards agree with each other: are squares and their number as printed?");
        case ErrorCode::NotConverged:
            return BoardWords::tr("No lens explains these boards: take more of them, at different angles.");
        default:
            return BoardWords::tr("The boards can't be calibrated from.");
    }
}

std::vector<LensFigure> figuresOf(const CameraCalibration& calibration) {
    const CameraModel& camera = calibration.camera;
    const auto sigma = [&](double IntrinsicsSigma::*value) {
        return calibration.sigma ? std::optional((*calibration.sigma).*value) : std::nullopt;
    };
    std::vector<LensFigure> figures{
        figure(BoardWords::tr("fx, px"), camera.fx, sigma(&IntrinsicsSigma::fx), 1),
        figure(BoardWords::tr("fy, px"), camera.fy, sigma(&IntrinsicsSigma::fy), 1),
        figure(BoardWords::tr("cx, px"), camera.cx, sigma(&IntrinsicsSigma::cx), 1),
        figure(BoardWords::tr("cy, px"), camera.cy, sigma(&IntrinsicsSigma::cy), 1),
    };
    static constexpr std::array kNames{"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
    for (std::size_t i = 0; i < camera.distortion.size(); ++i) {
        const bool isFisheye = camera.distortionModel == DistortionModel::Equidistant;
        const QString name = isFisheye ? QStringLiteral("k%1").arg(i + 1) : QString::fromLatin1(kNames.at(i));
        const auto spread = calibration.sigma && i < calibration.sigma->distortion.size()
                                ? std::optional(calibration.sigma->distortion[i])
                                : std::nullopt;
        // What was held at zero says nothing.
        if (camera.distortion[i] != 0 || (spread && *spread > 0))
            figures.push_back(figure(name, camera.distortion[i], spread, 4));
    }
    return figures;
}

}  // namespace skincal
