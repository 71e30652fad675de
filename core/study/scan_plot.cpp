#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/study/scan_study.h"

namespace skincal {
namespace {

constexpr double kPanelWidth = 300;
constexpr double kPanelHeight = 190;
constexpr double kLeft = 46;
constexpr double kRight = 12;
constexpr double kTop = 30;
constexpr double kBottom = 36;
constexpr std::size_t kColumns = 3;

struct Style {
    ScanMethod method;
    const char* colour;  ///< of a palette that the colour-blind can tell apart (Okabe and Ito)
    const char* dashes;
};
constexpr std::array<Style, 3> kStyles{{{ScanMethod::Coded, "#0072b2", ""},
                                        {ScanMethod::OneAtATime, "#e69f00", "6 3"},
                                        {ScanMethod::PaperSingle, "#333333", "2 3"}}};

const char* unitOf(Disturbance disturbance) {
    switch (disturbance) {
        case Disturbance::Ambient:
            return "mean grey level of the room";
        case Disturbance::Screen:
        case Disturbance::Mains50:
        case Disturbance::Mains60:
            return "grey levels";
        case Disturbance::Bump:
            return "px, half-way through the scan";
        case Disturbance::Focus:
            return "px of blur";
        case Disturbance::Crowding:
            return "px between LEDs";
        case Disturbance::None:
        case Disturbance::Person:
            return "";
        default:
            return "share";
    }
}

std::string text(double x, double y, const char* anchor, const std::string& words, const char* more = "") {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more, words);
}

/// One method's curve, its strengths evenly spaced in the order that they have in the study.
std::string curve(const std::vector<const ScanStudyRow*>& rows, const std::vector<double>& strengths,
                  const Style& style) {
    std::string points;
    std::string marks;
    for (const ScanStudyRow* row : rows) {
        const auto at = std::find(strengths.begin(), strengths.end(), row->what.strength) - strengths.begin();
        const double steps = std::max(1.0, static_cast<double>(strengths.size()) - 1);
        const double x = kLeft + (kPanelWidth - kLeft - kRight) * static_cast<double>(at) / steps;
        const double y = kTop + (kPanelHeight - kTop - kBottom) * (1 - row->score.foundShare());
        points += fmt::format("{:.1f},{:.1f} ", x, y);
        marks += row->score.wrong > 0
                     ? fmt::format(
                           "<path d=\"M{0:.1f} {1:.1f}l10 10m-10 0l10 -10\" stroke=\"#d55e00\" stroke-width=\"2\"/>\n",
                           x - 5, y - 5)
                     : fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", x, y, style.colour);
    }
    return fmt::format(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" "
        "stroke-dasharray=\"{}\"/>\n{}",
        points, style.colour, style.dashes, marks);
}

std::string panel(Disturbance disturbance, const std::vector<const ScanStudyRow*>& rows) {
    std::vector<double> strengths;
    for (const ScanStudyRow* row : rows) {
        if (std::find(strengths.begin(), strengths.end(), row->what.strength) == strengths.end())
            strengths.push_back(row->what.strength);
    }
    std::string svg = text(kLeft, 18, "start", std::string(name(disturbance)), " font-weight=\"bold\"");
    if (hasMirror(disturbance))
        svg += text(kPanelWidth - kRight, 18, "end", "found, or taken by the body");
    const double bottom = kPanelHeight - kBottom;
    for (const int share : {0, 50, 100}) {
        const double y = bottom - (bottom - kTop) * share / 100;
        svg += fmt::format("<path d=\"M{} {:.1f}H{}\" stroke=\"#cccccc\"/>\n", kLeft, y, kPanelWidth - kRight);
        svg += text(kLeft - 6, y + 4, "end", fmt::format("{} %", share));
    }
    for (std::size_t i = 0; i < strengths.size(); ++i) {
        const double steps = std::max(1.0, static_cast<double>(strengths.size()) - 1);
        svg += text(kLeft + (kPanelWidth - kLeft - kRight) * static_cast<double>(i) / steps, bottom + 15, "middle",
                    fmt::format("{}", strengths[i]));
    }
    svg += text(kPanelWidth - kRight, kPanelHeight - 6, "end", unitOf(disturbance));
    for (const Style& style : kStyles) {
        std::vector<const ScanStudyRow*> own;
        std::copy_if(rows.begin(), rows.end(), std::back_inserter(own),
                     [&](const ScanStudyRow* row) { return row->what.method == style.method; });
        svg += curve(own, strengths, style);
    }
    return svg;
}

}  // namespace

std::string scanPlot(const ScanStudy& study) {
    // Curves are of the skins that were scanned by every method; others have points but no strengths to compare.
    std::map<Disturbance, std::vector<const ScanStudyRow*>> panels;
    std::size_t modules = 0;
    for (const ScanStudyRow& row : study.rows) {
        if (modules == 0)
            modules = row.what.modules;
        if (row.what.modules == modules && row.what.disturbance != Disturbance::None)
            panels[row.what.disturbance].push_back(&row);
    }
    const std::size_t lines = (panels.size() + kColumns - 1) / kColumns;
    const double width = kPanelWidth * static_cast<double>(kColumns);
    const double height = 34 + kPanelHeight * static_cast<double>(lines);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" font-family=\"sans-serif\" font-size=\"11\">\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
        width, height);
    double x = kLeft;
    for (const Style& style : kStyles) {
        svg += fmt::format("<path d=\"M{:.0f} 18h24\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"{}\"/>\n", x,
                           style.colour, style.dashes);
        svg += text(x + 30, 22, "start", std::string(name(style.method)));
        x += 130;
    }
    svg += text(width - kRight, 22, "end",
                fmt::format("visible modules found, of {}; a cross where any was taken for another", modules));
    std::size_t i = 0;
    for (const auto& [disturbance, rows] : panels) {
        svg +=
            fmt::format("<g transform=\"translate({},{})\">\n{}</g>\n", kPanelWidth * static_cast<double>(i % kColumns),
                        34 + kPanelHeight * static_cast<double>(i / kColumns), panel(disturbance, rows));
        ++i;
    }
    return svg + "</svg>\n";
}

}  // namespace skincal
