// On screens with twice as many pixels everything is as large as it was, and sharper.

#include <gtest/gtest.h>

#include <QListView>
#include <QPainter>
#include <cmath>

#include "core/geometry/random.h"
#include "core/simulation/world.h"
#include "core/workflow/simulated_recording.h"
#include "tests/ui/window/driven_window.h"
#include "ui/widgets/board_picture.h"
#include "ui/widgets/curve_plot.h"
#include "ui/widgets/gravity_sphere.h"
#include "ui/widgets/histogram_view.h"
#include "ui/widgets/network_view.h"
#include "ui/widgets/overlap_graph.h"
#include "ui/widgets/residual_plot.h"
#include "ui/widgets/trace_plot.h"

namespace skincal {
namespace {

QImage drawn(QWidget& widget, int ratio) {
    QImage image(ratio * widget.size(), QImage::Format_RGB32);
    image.setDevicePixelRatio(ratio);
    image.fill(Qt::black);
    widget.render(&image);
    image.setDevicePixelRatio(1);
    return image;
}

/// Mean difference of grey levels.
double differenceOf(const QImage& a, const QImage& b) {
    double sum = 0;
    for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x)
            sum += std::abs(qGray(a.pixel(x, y)) - qGray(b.pixel(x, y)));
    }
    return sum / (a.width() * a.height());
}

/// How steep edges are: they are steeper the finer they are drawn.
double steepness(const QImage& image) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 1; x < image.width(); ++x)
            sum += std::pow(qGray(image.pixel(x, y)) - qGray(image.pixel(x - 1, y)), 2);
    }
    return sum;
}

/// The largest share of one of the four sides along which something is drawn that goes on beyond it.
double shareCutOff(const QImage& image) {
    const auto share = [](const std::vector<int>& side) {
        std::vector<int> sorted = side;
        std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
        const int ground = sorted[sorted.size() / 2];
        constexpr int kInk = 40;
        return static_cast<double>(
                   std::count_if(side.begin(), side.end(), [&](int grey) { return std::abs(grey - ground) > kInk; })) /
               static_cast<double>(side.size());
    };
    double most = 0;
    for (const int y : {0, image.height() - 1}) {
        std::vector<int> side;
        for (int x = 0; x < image.width(); ++x)
            side.push_back(qGray(image.pixel(x, y)));
        most = std::max(most, share(side));
    }
    for (const int x : {0, image.width() - 1}) {
        std::vector<int> side;
        for (int y = 0; y < image.height(); ++y)
            side.push_back(qGray(image.pixel(x, y)));
        most = std::max(most, share(side));
    }
    return most;
}

void expectSharpAtTwice(QWidget& widget, const char* name) {
    const QImage once = drawn(widget, 1);
    const QImage twice = drawn(widget, 2);
    ASSERT_GT(steepness(once), 0) << name << " draws nothing";
    const QImage back = twice.scaled(once.size(), Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
    EXPECT_LT(differenceOf(once, back), 4) << name << " is not laid out alike";
    const QImage blown = once.scaled(twice.size(), Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
    EXPECT_GT(steepness(twice), 1.25 * steepness(blown)) << name << " is no sharper";
    constexpr double kCorners = 0.04;  // those of rounded frames
    EXPECT_LT(shareCutOff(once), kCorners) << name;
    EXPECT_LT(shareCutOff(twice), kCorners) << name;
}

/// A picture with more in it than the widget has pixels.
QImage fineImage() {
    QImage image(1920, 1080, QImage::Format_RGB32);
    image.fill(QColor(30, 30, 30));
    QPainter painter(&image);
    for (int y = 200; y < 900; y += 96) {
        for (int x = 200; x < 1700; x += 96)
            painter.fillRect(x, y, 48, 48, Qt::white);
    }
    return image;
}

TEST(HighDpi, NetworkIsSharp) {
    NetworkView view;
    view.resize(560, 300);
    const World world = buildWorld(*findScenario("arm"), 1);
    std::vector<JudgedLink> links;
    for (const Link& link : world.skin.links) {
        JudgedLink& judged = links.emplace_back();
        judged.link = link;
    }
    view.setNetwork(layOutFlat(world.skin, links));
    expectSharpAtTwice(view, "network");
    view.setNetwork({});
    view.setPlaceholder("Modules appear here once the skin is connected.");
    expectSharpAtTwice(view, "empty network");
}

TEST(HighDpi, PicturesAreSharp) {
    BoardPicture view;
    view.resize(640, 360);
    view.setImage(fineImage());
    view.setMarks(
        {{QPointF(600, 400), Qt::yellow, ModuleId{1}, true, true}, {QPointF(900, 700), Qt::cyan, ModuleId{2}}});
    view.setShapes({{QPolygonF{QPointF(1000, 300), QPointF(1200, 300), QPointF(1100, 500)}, Qt::red, ModuleId{2}}});
    view.setCoverage(4, 3, std::vector<int>(12, 5));
    view.setCorners({QPointF(700, 500), QPointF(800, 520)}, Qt::green);
    expectSharpAtTwice(view, "picture");
}

TEST(HighDpi, PlotsAreSharp) {
    Random random(1, "plots");
    CurvePlot curve;
    curve.resize(300, 180);
    curve.setTitle("Expected error of an edge");
    curve.setAbscissa("poses");
    curve.setUnit("°");
    curve.setGoal(2, "good: below 2°");
    curve.setValues({std::nullopt, std::nullopt, 9.0, 4.0, 2.1, 1.4, 1.1});
    expectSharpAtTwice(curve, "curve");

    HistogramView histogram;
    histogram.resize(256, 90);
    PictureFigures figures;
    figures.pixels = 1000;
    for (std::size_t i = 0; i < figures.histogram.size(); ++i)
        figures.histogram.at(i) = i % 16 < 8 ? 900 : 10;
    histogram.setFigures(figures);
    expectSharpAtTwice(histogram, "histogram");

    ResidualPlot residuals;
    residuals.resize(260, 220);
    std::vector<ResidualPlot::Cloud> clouds;
    for (std::size_t board = 0; board < 20; ++board) {
        ResidualPlot::Cloud& cloud = clouds.emplace_back();
        cloud.sign = boardSign(board);
        for (int i = 0; i < 12; ++i)
            cloud.residuals.emplace_back(0.2 * random.normal(), 0.2 * random.normal());
    }
    residuals.setClouds(std::move(clouds));
    expectSharpAtTwice(residuals, "residuals");

    TracePlot trace;
    trace.resize(560, 180);
    trace.setScale(0, 4);
    trace.setSpan(30);
    TracePlot::Line line{"Module 12", "2.41", QColor("#0072b2"), {}};
    for (int i = 0; i < 200; ++i) {
        const auto value = static_cast<float>(2 + std::sin(0.2 * i));
        line.ranges.emplace_back(value, value + 0.1F);
    }
    trace.setLines({line});
    expectSharpAtTwice(trace, "trace");
}

TEST(HighDpi, SphereAndGraphAreSharp) {
    GravitySphere sphere;
    sphere.resize(260, 240);
    sphere.setCovered({Vector3d::UnitX(), Vector3d(1, 1, 1).normalized(), Vector3d::UnitZ()});
    sphere.setCurrent(Vector3d::UnitZ());
    sphere.setTarget(Vector3d(1, 0.3, 0.4).normalized());
    expectSharpAtTwice(sphere, "sphere");

    OverlapGraph graph;
    graph.resize(520, 220);
    std::vector<ViewState> views(3);
    std::vector<PatchState> patches(4);
    for (std::size_t i = 0; i < views.size(); ++i) {
        views[i].name = "view" + std::to_string(i + 1);
        views[i].isPlaced = i != 1;
    }
    for (std::size_t k = 0; k < patches.size(); ++k) {
        patches[k].patch = PatchId{static_cast<std::uint32_t>(k)};
        patches[k].modules = 5;
        patches[k].isPlaced = k < 2;
        patches[k].views = {"view1", k % 2 == 0 ? "view2" : "view3"};
    }
    graph.setGraph(std::move(views), std::move(patches));
    expectSharpAtTwice(graph, "graph");
}

TEST(HighDpi, ListsOfStepsAndProblemsAreSharp) {
    DrivenWindow driven;
    driven.session().load(openedFrom(recordingOf(buildWorld(*findScenario("arm"), 1))));
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    // A selected line is tinted to its ends.
    for (const char* name : {"steps", "problems"}) {
        auto* list = driven.find<QListView>(name);
        const QImage once = drawn(*list, 1);
        const QImage twice = drawn(*list, 2);
        const QImage back = twice.scaled(once.size(), Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
        EXPECT_LT(differenceOf(once, back), 4) << name;
        const QImage blown = once.scaled(twice.size(), Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
        EXPECT_GT(steepness(twice), 1.25 * steepness(blown)) << name;
    }
}

}  // namespace
}  // namespace skincal
