#include "ui/presenters/camera_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/ui/presenters/desk.h"

namespace skincal {
namespace {

using test::Desk;
using testing::HasSubstr;

TEST(CameraWords, SayWhatToDoOfEveryTrouble) {
    std::set<QString> said;
    for (int trouble = 0; trouble <= static_cast<int>(CameraTrouble::Ended); ++trouble) {
        const QString words = cameraWords({static_cast<CameraTrouble>(trouble), "/dev/video0", "reason"});
        EXPECT_TRUE(words.contains(": ") || words.contains("Run ")) << words.toStdString();
        EXPECT_FALSE(words.contains("%")) << words.toStdString();
        said.insert(words);
    }
    EXPECT_EQ(said.size(), static_cast<std::size_t>(CameraTrouble::Ended) + 1);
}

TEST(CameraWords, NameTheCommandThatMendsPermission) {
    EXPECT_THAT(cameraWords({CameraTrouble::Forbidden, "/dev/video0"}).toStdString(),
                HasSubstr("sudo usermod -aG video $USER"));
    EXPECT_THAT(cameraWords({CameraTrouble::Forbidden, "/home/x.avi"}).toStdString(), HasSubstr("chmod u+r"));
    EXPECT_THAT(cameraWords({CameraTrouble::Busy, "/dev/video0"}).toStdString(), HasSubstr("fuser -v /dev/video0"));
}

TEST(CameraWords, OfASourceWithoutCodeAreItsOwn) {
    Desk desk;
    desk.workbench.chooseCamera(0);
    EXPECT_EQ(failureWords(*desk.workbench.camera(), "why"), "why");
}

TEST(CameraWords, TellWhatIsHeldAndWhatIsNot) {
    using Outcome = ControlState::Outcome;
    const auto states = [](Outcome exposure, Outcome gain, Outcome rest) {
        return std::vector<ControlState>{{CameraControl::Exposure, exposure},
                                         {CameraControl::Gain, gain},
                                         {CameraControl::Focus, rest},
                                         {CameraControl::WhiteBalance, rest}};
    };
    EXPECT_EQ(controlWords({}), "");
    EXPECT_FALSE(mayBrightnessChange({}));
    const auto held = states(Outcome::Locked, Outcome::Locked, Outcome::Locked);
    EXPECT_EQ(controlWords(held), "Held still: exposure, gain, focus, white balance.");
    EXPECT_FALSE(mayBrightnessChange(held));
    const auto some = states(Outcome::Locked, Outcome::Automatic, Outcome::NotOffered);
    EXPECT_EQ(
        controlWords(some),
        "Held still: exposure. Not held: gain (it stays automatic). Not held: focus, white balance (the camera has "
        "no control for it).");
    EXPECT_TRUE(mayBrightnessChange(some));
    EXPECT_TRUE(mayBrightnessChange(states(Outcome::NoAccess, Outcome::Locked, Outcome::Locked)));
    EXPECT_FALSE(mayBrightnessChange(states(Outcome::Locked, Outcome::NotOffered, Outcome::Automatic)));
}

TEST(CameraWords, CountPicturesThatWereNotUsed) {
    EXPECT_EQ(refusedWords({}), "");
    std::array<std::uint64_t, kFrameFaults> refused{};
    refused[static_cast<std::size_t>(FrameFault::RepeatedContent)] = 3;
    refused[static_cast<std::size_t>(FrameFault::WrongSize)] = 1;
    EXPECT_EQ(refusedWords(refused), "Pictures not used: 1 of another size, 3 the same as the one before.");
}

TEST(CameraOffers, ChangeAndTheChosenOneStaysChosen) {
    Desk desk;
    const auto make = desk.workbench.cameraOffers[0].make;
    const auto offers = [&](const std::vector<const char*>& keys) {
        std::vector<Offer<FrameSource>> result = {{"rig", "", make}};
        for (const char* key : keys)
            result.push_back({"webcam", "", make, key});
        return result;
    };
    desk.workbench.setCameraOffers(offers({"a", "b"}));
    EXPECT_EQ(desk.workbench.chosenCamera(), -1);
    desk.workbench.chooseCamera(2);
    const FrameSource* camera = desk.workbench.camera();
    desk.workbench.setCameraOffers(offers({"b"}));
    EXPECT_EQ(desk.workbench.chosenCamera(), 1);
    desk.workbench.setCameraOffers(offers({"c", "a", "b"}));
    EXPECT_EQ(desk.workbench.chosenCamera(), 3);
    EXPECT_EQ(desk.workbench.camera(), camera);
    desk.workbench.setCameraOffers(offers({"c"}));
    EXPECT_EQ(desk.workbench.chosenCamera(), -1);
    EXPECT_EQ(desk.workbench.camera(), camera);
    desk.workbench.chooseCamera(0);
    desk.workbench.setCameraOffers(offers({}));
    EXPECT_EQ(desk.workbench.chosenCamera(), 0);
}

}  // namespace
}  // namespace skincal
