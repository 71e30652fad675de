#pragma once

#include "core/rig/simulated_camera.h"
#include "core/rig/simulated_skin.h"
#include "tests/unit/rig/pass.h"
#include "tests/wait_for.h"
#include "ui/presenters/connect_presenter.h"
#include "ui/presenters/export_presenter.h"
#include "ui/presenters/pose_presenter.h"
#include "ui/presenters/problem_model.h"
#include "ui/presenters/scan_presenter.h"
#include "ui/presenters/step_model.h"
#include "ui/presenters/view_preview.h"

namespace skincal::test {

/// All presenters at a simulated rig whose clock goes as fast as events do; nothing is drawn.
class Desk {
  public:
    explicit Desk(const Scenario& scenario = *findScenario("coded"), std::uint64_t seed = 1)
        : rig(scenario, seed), workbench(nullptr) {
        rig.setSpeed(0);
        workbench.skinOffers.push_back({"skin", "", [this] { return std::make_unique<SimulatedSkin>(rig); }});
        workbench.skinOffers.push_back({"other skin", "", [this] { return std::make_unique<SimulatedSkin>(rig); }});
        workbench.cameraOffers.push_back({"camera", "", [this] { return std::make_unique<SimulatedCamera>(rig); }});
        workbench.cameraOffers.push_back({"other", "", [this] { return std::make_unique<SimulatedCamera>(rig); }});
        const auto poseOf = [this](ModuleId module) {
            return rig.world().T_r_u.at(rig.world().skin.indexById().at(module));
        };
        RigHands hands;
        hands.holds = [modules = rig.world().skin.indexById()](ModuleId module) { return modules.contains(module); };
        hands.turnBody = [this, poseOf](ModuleId module, const Vector3d& up_u) {
            rig.turnBody(poseOf(module).linear() * up_u);
        };
        hands.moveCamera = [this, poseOf](ModuleId module, const Isometry3d& T_u_v) {
            rig.moveCamera(poseOf(module) * T_u_v);
        };
        hands.moveCameraOn = [this] {
            place_ = (place_ + 1) % rig.suggestedViews().size();
            rig.moveCamera(rig.suggestedViews()[place_]);
        };
        hands.holdBoard = [this](const BoardPlan& plan) { rig.holdBoard(plan); };
        hands.putBoardAway = [this] { rig.putBoardAway(); };
        hands.intrinsics = rig.world().scenario.camera;
        workbench.hands = std::move(hands);
    }

    [[nodiscard]] Session& session() { return workbench.session(); }

    [[nodiscard]] bool connectSkin() {
        connection.connectSkin();
        return waitFor([&] { return workbench.isSkinReady(); });
    }
    [[nodiscard]] bool capturePoses(std::size_t poses) {
        pose.setActive(true);
        const auto count = [&] { return posesOf(session().measured(), session().decisions()).size(); };
        while (count() < poses) {
            const std::size_t before = count();
            if (before > 0)
                pose.turnToTarget();
            if (!waitFor([&] { return count() > before; }))
                return false;
        }
        pose.setActive(false);
        return true;
    }
    [[nodiscard]] bool startCamera() {
        session().decide("intrinsics", [&](Decisions& decisions) { decisions.camera = rig.world().scenario.camera; });
        workbench.chooseCamera(0);
        scan.setActive(true);
        return waitFor([&] { return scan.obstacle().isEmpty(); });
    }
    /// @return whether there is one view more.
    [[nodiscard]] bool scanHere() {
        const std::size_t before = session().measured().views.size();
        scan.start();
        return waitFor([&] { return !isScanning(); }) && session().measured().views.size() == before + 1;
    }
    [[nodiscard]] bool isScanning() const {
        const ScanRun& run = scan.state();
        return run.isRunning() || run.phase == ScanRun::Phase::Decoding;
    }
    [[nodiscard]] bool moveCamera() {
        views.moveCamera();
        return waitFor([&] { return rig.isCameraAtRest(); });
    }
    [[nodiscard]] bool isSolved() {
        return session().solution() && session().solution()->revision == session().revision() && !session().isSolving();
    }
    /// @return the complaint; empty where the file was written.
    [[nodiscard]] QString write(std::size_t format, const std::filesystem::path& file) {
        std::optional<QString> outcome;
        const QObject receiver;
        QObject::connect(&exporter, &ExportPresenter::failed, &receiver, [&](const QString& why) { outcome = why; });
        QObject::connect(&exporter, &ExportPresenter::written, &receiver, [&] { outcome = QString(); });
        exporter.write(format, file);
        return waitFor([&] { return outcome.has_value(); }) ? *outcome : QStringLiteral("nothing was heard of it");
    }
    [[nodiscard]] QString previewOf(std::size_t format, int lines) {
        std::optional<QString> text;
        const QObject receiver;
        QObject::connect(&exporter, &ExportPresenter::previewed, &receiver, [&](const QString& of) { text = of; });
        exporter.preview(format, lines);
        return waitFor([&] { return text.has_value(); }) ? *text : QStringLiteral("nothing came");
    }
    /// What the camera will see lit once all commands show.
    [[nodiscard]] bool isDark() { return rig.litAt(RigClock::Time::max()).empty(); }

    SimulatedRig rig;
    Workbench workbench;
    ConnectPresenter connection{workbench};
    PosePresenter pose{workbench};
    ScanPresenter scan{workbench};
    ViewsPresenter views{workbench};
    ViewPreview preview{workbench, scan, views};
    ExportPresenter exporter{workbench};
    StepModel steps{workbench, connection, scan};
    ProblemModel problems{workbench, connection, scan};

  private:
    std::size_t place_ = 0;
};

}  // namespace skincal::test
