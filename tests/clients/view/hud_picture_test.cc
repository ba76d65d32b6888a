#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/clients/view/made_game.h"
#include "tests/clients/view/made_person.h"
#include "tests/clients/view/made_stream.h"
#include "tests/clients/view/picture_fixture.h"

// The panels at several sizes of the picture: none draws outside its own box.
namespace footing::render {
namespace {

struct Size {
  int width = 0, height = 0;
};
constexpr Size kPictureSizes[] = {{640, 400}, {1280, 720}, {2560, 1440}};

std::string SizedName(const std::string& name, const Size& size) {
  return name + "_" + std::to_string(size.width) + "x" + std::to_string(size.height);
}

class HudPictureTest : public PictureFixture {
 protected:
  void TearDown() override { Resize(kWidth, kHeight); }

  /// Pixels that the panels change outside of every box. The stamp and the middle count as boxes.
  static int Strays(const scene::Picture& picture, const scene::Model& model,
                    const scene::WorldFrame& frame, std::int64_t now_ns, const Size& size,
                    const std::string& name) {
    Resize(size.width, size.height);
    HudOptions subject;
    subject.hidden = true;
    const Image with = Show(picture, model, frame, now_ns, {}, SizedName(name, size));
    const Image without =
        Show(picture, model, frame, now_ns, subject, SizedName(name + "_bare", size));
    const ImVec2 pixels(static_cast<float>(size.width), static_cast<float>(size.height));
    const HudBoxes boxes =
        BoxesOf({picture, model, frame, now_ns, model, now_ns}, {}, pixels, HudScale(pixels, 1));
    std::vector<Box> all{boxes.stamp, boxes.middle};
    for (const auto& box :
         {boxes.character, boxes.strips, boxes.devices, boxes.interface, boxes.boards}) {
      if (box) all.push_back(*box);
    }
    int strays = 0;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const auto i = static_cast<std::size_t>(3 * (y * size.width + x));
        if (std::abs(with.rgb[i] - without.rgb[i]) <= 2) continue;
        strays += std::none_of(all.begin(), all.end(), [x, y](const Box& box) {
          return x >= box.low.x - 2 && x < box.high.x + 2 && y >= box.low.y - 2 &&
                 y < box.high.y + 2;
        });
      }
    }
    return strays;
  }

  /// Pixels that differ well between two pictures, inside a box and outside of it.
  static std::pair<int, int> Changed(const Image& with, const Image& without, const Box& box,
                                     const Size& size) {
    int inside = 0, outside = 0;
    for (int i = 0; i < size.width * size.height; ++i) {
      const auto first = static_cast<std::size_t>(3 * i);
      if (std::abs(with.rgb[first] - without.rgb[first]) <= 8) continue;
      const int x = i % size.width, y = i / size.width;
      const bool in =
          x >= box.low.x - 2 && x < box.high.x + 2 && y >= box.low.y - 2 && y < box.high.y + 2;
      ++(in ? inside : outside);
    }
    return {inside, outside};
  }

  struct Shown {
    const scene::Model& model;
    const scene::WorldFrame& frame;
  };
  /// Compares two pictures at every size, with the panels and without them: `check` gets how many
  /// pixels differ in the box in the middle, and none may differ outside of it.
  static void CompareMiddles(
      const scene::Picture& picture, const Shown& first, const Shown& second,
      const std::string& what,
      const std::function<void(bool hidden, int inside, const std::string& name)>& check) {
    const std::int64_t now_ns = scene::made::ClockAt(12);
    for (const Size& size : kPictureSizes) {
      Resize(size.width, size.height);
      const ImVec2 pixels(static_cast<float>(size.width), static_cast<float>(size.height));
      for (const bool hidden : {false, true}) {
        HudOptions options;
        options.hidden = hidden;
        const auto name = SizedName(hidden ? what + "_alone" : what, size);
        const Image with = Show(picture, first.model, first.frame, now_ns, options, name);
        const Image without =
            Show(picture, second.model, second.frame, now_ns, options, name + "_bare");
        const HudContent content{picture, first.model, first.frame, now_ns, first.model, now_ns};
        const Box middle = BoxesOf(content, options, pixels, HudScale(pixels, 1)).middle;
        const auto [inside, outside] = Changed(with, without, middle, size);
        check(hidden, inside, name);
        EXPECT_EQ(outside, 0) << name;
      }
    }
  }
};

TEST_F(HudPictureTest, ThePanelsOfTheBirdStayInTheirBoxesAtEverySize) {
  const scene::made::Wish wish;
  const scene::Model model = scene::made::ModelAfter(12, wish);
  scene::Stage stage;
  const scene::WorldFrame frame = scene::made::TickAt(12, wish).frame.value();
  const scene::Picture picture = stage.Advance(model, frame, scene::made::ClockAt(12), 0.01, {});
  for (const Size& size : kPictureSizes) {
    EXPECT_EQ(Strays(picture, model, frame, scene::made::ClockAt(12), size, "bird"), 0)
        << size.width;
  }
}

TEST_F(HudPictureTest, ATaskIsSeenAtEverySizeAlsoByThePersonWhoSeesTheWorldAlone) {
  const scene::made::Wish wish;
  const scene::Model model = scene::made::ModelAfter(12, wish);
  const scene::WorldFrame bare = scene::made::TickAt(12, wish).frame.value();
  scene::WorldFrame frame = bare;
  stream::TrialState& trial = frame.characters.front().trial.emplace();
  trial.trial = "p07-2";
  trial.finish_m = 60;
  trial.to_mark_m = 12;
  trial.instruction = "walk to the line, then run";
  trial.progress.phase = stream::TrialPhase::kRunning;
  trial.progress.task_phase = stream::TaskPhase::kAhead;
  scene::Stage stage;
  const std::int64_t now_ns = scene::made::ClockAt(12);
  const scene::Picture picture = stage.Advance(model, frame, now_ns, 0.01, {});
  CompareMiddles(
      picture, {model, frame}, {model, bare}, "task",
      [](bool, int inside, const std::string& name) { EXPECT_GT(inside, 1000) << name; });
}

TEST_F(HudPictureTest, LostDevicesAreSeenAtEverySizeAlsoByThePersonWhoSeesTheWorldAlone) {
  for (const auto interface : stream::kUserInterfaces) {
    scene::made::Wish wish{.gait = stream::Gait::kStep, .speed_mps = 0, .interface = interface};
    const scene::Model model = scene::made::ModelAfter(3, wish);
    const scene::WorldFrame bare = scene::made::TickAt(12, wish).frame.value();
    const bool boards = interface == stream::UserInterface::kBoards;
    scene::WorldFrame frame = bare;
    stream::InterfaceState& state = frame.characters.front().interface;
    state.activity = stream::Activity::kAbsent;
    state.missing_roles =
        stream::RoleBit(boards ? stream::DeviceRole::kLeftBoard : stream::DeviceRole::kLeftHand) |
        stream::RoleBit(boards ? stream::DeviceRole::kRightBoard : stream::DeviceRole::kRightHand);
    scene::Stage stage;
    const std::int64_t now_ns = scene::made::ClockAt(12);
    const scene::Picture picture = stage.Advance(model, bare, now_ns, 0.01, {});
    // The small warnings of the panels are outside of the middle; without panels there are none.
    for (const Size& size : kPictureSizes) {
      Resize(size.width, size.height);
      const ImVec2 pixels(static_cast<float>(size.width), static_cast<float>(size.height));
      for (const bool hidden : {false, true}) {
        HudOptions options;
        options.hidden = hidden;
        const std::string what = std::string("lost_") + stream::Name(interface);
        const auto name = SizedName(hidden ? what + "_alone" : what, size);
        const Image with = Show(picture, model, frame, now_ns, options, name);
        const Image without = Show(picture, model, bare, now_ns, options, name + "_bare");
        const HudContent content{picture, model, frame, now_ns, model, now_ns};
        const Box middle = BoxesOf(content, options, pixels, HudScale(pixels, 1)).middle;
        const auto [inside, outside] = Changed(with, without, middle, size);
        EXPECT_GT(inside, size.width * size.height / 40) << name;
        EXPECT_TRUE(!hidden || outside == 0) << name;
      }
    }
  }
}

TEST_F(HudPictureTest, AGameIsSeenAtEverySizeAlsoWithoutThePanels) {
  const scene::made::Wish wish;
  const scene::Model bare = scene::made::ModelAfter(12, wish);
  scene::Model model = bare;
  model.game = scene::made::Game();
  const scene::WorldFrame frame = scene::made::TickAt(12, wish).frame.value();
  scene::Stage stage;
  const std::int64_t now_ns = scene::made::ClockAt(12);
  const scene::Picture picture = stage.Advance(bare, frame, now_ns, 0.01, {});
  CompareMiddles(
      picture, {model, frame}, {bare, frame}, "game",
      [](bool, int inside, const std::string& name) { EXPECT_GT(inside, 1000) << name; });
}

TEST_F(HudPictureTest, TheStagesOfAGameAreReadAtEverySizeAlsoWithoutThePanels) {
  const scene::made::Wish wish{.gait = stream::Gait::kStep};
  const scene::Model bare = scene::made::ModelAfter(12, wish);
  const scene::WorldFrame frame = scene::made::TickAt(12, wish).frame.value();
  scene::Stage stage;
  const std::int64_t now_ns = scene::made::ClockAt(12);
  const scene::Picture picture = stage.Advance(bare, frame, now_ns, 0.01, {});
  scene::Model round = bare, countdown = bare, over = bare;
  round.game = countdown.game = over.game = scene::made::Game();
  countdown.game.phase = stream::GamePhase::kCountdown;
  countdown.game.left_s = 2.4;
  over.game.phase = stream::GamePhase::kOver;
  for (const auto& [model, name] :
       {std::pair(&countdown, "game_countdown"), std::pair(&over, "game_over")}) {
    CompareMiddles(
        picture, {*model, frame}, {round, frame}, name,
        [](bool, int inside, const std::string& where) { EXPECT_GT(inside, 1000) << where; });
  }
}

TEST_F(HudPictureTest, AFinishIsSeenWithThePanelsAndNeverOnTheSubjectsScreen) {
  const scene::made::Wish wish{.gait = stream::Gait::kStep};
  const scene::Model model = scene::made::ModelAfter(12, wish);
  scene::WorldFrame running = scene::made::TickAt(12, wish).frame.value();
  stream::TrialState& trial = running.characters.front().trial.emplace();
  trial.finish_m = 66;
  trial.progress.phase = stream::TrialPhase::kRunning;
  trial.progress.time_s = 41.2;
  scene::WorldFrame finished = running;
  finished.characters.front().trial->progress.phase = stream::TrialPhase::kFinished;
  scene::Stage stage;
  const std::int64_t now_ns = scene::made::ClockAt(12);
  const scene::Picture picture = stage.Advance(model, running, now_ns, 0.01, {});
  Resize(kWidth, kHeight);
  HudOptions subject;
  subject.hidden = true;
  EXPECT_EQ(Show(picture, model, finished, now_ns, subject, "finish_subject").rgb,
            Show(picture, model, running, now_ns, subject, "running_subject").rgb);
  EXPECT_NE(Show(picture, model, finished, now_ns, {}, "finish").rgb,
            Show(picture, model, running, now_ns, {}, "running").rgb);
}

TEST_F(HudPictureTest, AStudyIsSeenByItsExperimenterAloneAtEverySize) {
  const scene::made::Wish wish;
  const scene::Model bare = scene::made::ModelAfter(12, wish);
  scene::Model model = bare;
  const std::int64_t now_ns = scene::made::ClockAt(12);
  stream::StudyState& study = model.study.state;
  study.participant = "P07";
  study.phase = "wrist.straight1";
  study.doing = "Practice of wrist.";
  study.next = "wrist.straight2";
  study.keys = "Enter ends it early";
  study.left_s = 100;
  model.study.received_ns = now_ns;
  const scene::WorldFrame frame = scene::made::TickAt(12, wish).frame.value();
  scene::Stage stage;
  const scene::Picture picture = stage.Advance(bare, frame, now_ns, 0.01, {});
  CompareMiddles(picture, {model, frame}, {bare, frame}, "study",
                 [](bool hidden, int inside, const std::string& name) {
                   EXPECT_EQ(inside > 1000, !hidden) << name << ": " << inside;
                 });
}

TEST_F(HudPictureTest, AParticipantReadsWhatComesNextAtEverySizeAndNothingInATrial) {
  const scene::made::Wish wish{.gait = stream::Gait::kStep};
  const scene::Model bare = scene::made::ModelAfter(12, wish);
  scene::Model model = bare;
  const std::int64_t now_ns = scene::made::ClockAt(12);
  stream::StudyState& study = model.study.state;
  study.participant = "P07";
  study.interface = "wrist";
  study.phase = "wrist.straight1";
  study.next = "wrist.survey";
  study.attempt = 1;
  model.study.received_ns = now_ns;
  const scene::WorldFrame ready = scene::made::TickAt(12, wish).frame.value();
  scene::WorldFrame running = ready;
  stream::TrialState& trial = running.characters.front().trial.emplace();
  trial.trial = "P07.wrist.straight1.1";
  trial.progress.phase = stream::TrialPhase::kRunning;
  scene::Stage stage;
  const scene::Picture picture = stage.Advance(bare, ready, now_ns, 0.01, {});
  HudOptions subject;
  subject.hidden = true;
  struct State {
    const char* name = "";
    stream::StudyActivity activity = stream::StudyActivity::kWait;
    double left_s = 0;
  };
  for (const Size& size : kPictureSizes) {
    Resize(size.width, size.height);
    const ImVec2 pixels(static_cast<float>(size.width), static_cast<float>(size.height));
    const Image plain = Show(picture, bare, ready, now_ns, subject, SizedName("subject", size));
    for (const State& state : {State{"rest", stream::StudyActivity::kRest, 42},
                               State{"count_in", stream::StudyActivity::kTrial, 3},
                               State{"finished", stream::StudyActivity::kFinished, 0},
                               State{"get_ready", stream::StudyActivity::kGetReady, 0},
                               State{"survey", stream::StudyActivity::kSurvey, 0},
                               State{"practice", stream::StudyActivity::kPractice, 250},
                               State{"wait", stream::StudyActivity::kWait, 0}}) {
      // The highest one at every size, the others where there is the least space.
      if (size.width > 640 && state.activity != stream::StudyActivity::kRest) continue;
      study.activity = state.activity;
      study.left_s = state.left_s;
      const auto name = SizedName(std::string("subject_") + state.name, size);
      const Image with = Show(picture, model, ready, now_ns, subject, name);
      const HudContent content{picture, model, ready, now_ns, model, now_ns};
      const Box middle = BoxesOf(content, subject, pixels, HudScale(pixels, 1)).middle;
      const auto [inside, outside] = Changed(with, plain, middle, size);
      EXPECT_GT(inside, 1000) << name;
      EXPECT_EQ(outside, 0) << name;
    }
    study.activity = stream::StudyActivity::kTrial;
    study.left_s = 3;
    const auto name = SizedName("subject_trial", size);
    const Image with = Show(picture, model, running, now_ns, subject, name);
    EXPECT_EQ(with.rgb, plain.rgb) << name;
  }
}

TEST_F(HudPictureTest, ADeviceIsNotShownAsLiveWhileItsServerIsNotThere) {
  const scene::made::Wish wish;
  scene::Model model = scene::made::ModelAfter(12, wish);
  model.links = {{"unix:/s", "footingd", scene::LinkState::kLive, ""}};
  const std::int64_t now_ns = scene::made::ClockAt(12);
  const scene::WorldFrame frame = scene::made::TickAt(12, wish).frame.value();
  scene::Stage stage;
  const scene::Picture picture = stage.Advance(model, frame, now_ns, 0.01, {});
  Resize(kWidth, kHeight);
  const HudContent content{picture, model, frame, now_ns, model, now_ns};
  const auto box = BoxesOf(content, {}, {kWidth, kHeight}, 1).devices;
  ASSERT_TRUE(box);
  const auto share_of_green = [&](const std::string& name) {
    const Image image = Show(picture, model, frame, now_ns, {}, name);
    // The dots of the devices, at the left edge below the bar of the response.
    const Region dots{(box->low.x + 10) / kWidth, (box->low.x + 26) / kWidth,
                      (box->low.y + 106) / kHeight, box->high.y / kHeight};
    return ShareOf(
        image, [](int red, int green, int blue) { return green > 180 && red < 130 && blue < 170; },
        dots);
  };
  EXPECT_GT(share_of_green("devices_live"), 0.002);
  model.links[0].state = scene::LinkState::kConnecting;
  EXPECT_EQ(share_of_green("devices_unknown"), 0);
}

TEST_F(HudPictureTest, TheInterfacePanelStaysInItsBoxForEveryInterface) {
  for (const auto interface : stream::kUserInterfaces) {
    scene::made::Wish wish;
    wish.interface = interface;
    const scene::Model model = scene::made::ModelAfter(3, wish);
    scene::Stage stage;
    const std::int64_t now_ns = scene::made::ClockAt(3);
    const scene::WorldFrame frame = scene::made::TickAt(3, wish).frame.value();
    const scene::Picture picture = stage.Advance(model, frame, now_ns, 0.01, {});
    const std::string name = stream::Name(interface);
    EXPECT_EQ(Strays(picture, model, frame, now_ns, {1280, 720}, name), 0) << name;
    const HudBoxes boxes =
        BoxesOf({picture, model, frame, now_ns, model, now_ns}, {}, {1280, 720}, 1);
    EXPECT_TRUE(boxes.interface) << name;
  }
}

TEST_F(HudPictureTest, AProblemOfTheInterfaceIsWrittenWhole) {
  const scene::made::Wish wish{.interface = stream::UserInterface::kLeg};
  const scene::Model model = scene::made::ModelAfter(3, wish);
  scene::WorldFrame frame = scene::made::TickAt(3, wish).frame.value();
  scene::Stage stage;
  const std::int64_t now_ns = scene::made::ClockAt(3);
  const scene::Picture picture = stage.Advance(model, frame, now_ns, 0.01, {});
  const Image without = Show(picture, model, frame, now_ns, {}, "mounted");
  frame.characters.front().interface.unmounted_roles =
      stream::RoleBit(stream::DeviceRole::kLeftLeg) |
      stream::RoleBit(stream::DeviceRole::kRightLeg);
  EXPECT_EQ(Strays(picture, model, frame, now_ns, {kWidth, kHeight}, "unmounted"), 0);
  const Image with = Show(picture, model, frame, now_ns, {}, "unmounted");
  const HudBoxes boxes =
      BoxesOf({picture, model, frame, now_ns, model, now_ns}, {}, {kWidth, kHeight}, 1);
  ASSERT_TRUE(boxes.interface);
  // A line of its own under the command: "no mounting: left leg, right leg (footing-ctl setup)".
  const auto amber = [](int r, int g, int b) { return r > 200 && g > 140 && b < 110; };
  const auto rows = [&](const Image& image) {
    int count = 0;
    for (int y = static_cast<int>(boxes.interface->low.y); y < boxes.interface->high.y; ++y) {
      int letters = 0;
      for (auto x = static_cast<int>(boxes.interface->low.x); x < boxes.interface->high.x; ++x) {
        const auto i = static_cast<std::size_t>(3 * (y * kWidth + x));
        letters += amber(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]) ? 1 : 0;
      }
      count += y > boxes.interface->low.y + 140 && letters > 10 ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(rows(without), 0);
  EXPECT_GT(rows(with), 4);
}

TEST_F(HudPictureTest, TheStickGaugeLightsUpWhereTheCharacterTurnsInPlace) {
  const scene::made::Wish wish{.gait = stream::Gait::kStep,
                               .interface = stream::UserInterface::kJoystick};
  const scene::Model model = scene::made::ModelAfter(3, wish);
  scene::WorldFrame frame = scene::made::TickAt(3, wish).frame.value();
  stream::InterfaceState& state = frame.characters.front().interface;
  state.stick = {.valid = true, .x = 0.9, .y = -0.3};  // 108 degrees to the right.
  scene::Stage stage;
  const std::int64_t now_ns = scene::made::ClockAt(3);
  const scene::Picture picture = stage.Advance(model, frame, now_ns, 0.01, {});
  const auto shown = [&](double turn_share, const std::string& name) {
    state.turn.share = turn_share;
    return Show(picture, model, frame, now_ns, {}, name);
  };
  const Image right = shown(1.5, "stick_right"), straight = shown(0, "stick_straight");
  const HudBoxes boxes =
      BoxesOf({picture, model, frame, now_ns, model, now_ns}, {}, {kWidth, kHeight}, 1);
  ASSERT_TRUE(boxes.interface);
  Box stick = *boxes.interface;  // Its right half; the gauge of turns is in the last column.
  stick.low.x += stick.width() / 6;
  stick.high.x = stick.low.x + stick.width() / 5;
  EXPECT_GT(Changed(right, straight, stick, {kWidth, kHeight}).first, 100);
}

TEST_F(HudPictureTest, TheTPosePromptStaysOutOfThePanelsHoweverLongItIs) {
  scene::made::PersonWish wish;
  wish.calibrated = false;
  scene::Model model = scene::made::PersonModelAfter(2, wish);
  scene::WorldFrame frame = scene::made::PersonTickAt(2, wish).frame.value();
  frame.characters.front().body->note =
      "Step onto both boards, one foot on each, raise both arms to the side up to the shoulders, "
      "and then stand still";
  scene::Stage stage;
  const scene::Picture picture = stage.Advance(model, frame, scene::made::ClockAt(2), 0.01, {});
  for (const Size& size : kPictureSizes) {
    EXPECT_EQ(Strays(picture, model, frame, scene::made::ClockAt(2), size, "t_pose"), 0)
        << size.width;
  }
}

TEST_F(HudPictureTest, ThePanelsOfAPersonStayInTheirBoxesAtEverySize) {
  const scene::made::PersonWish wish;
  const scene::Model model = scene::made::PersonModelAfter(2, wish);
  const scene::WorldFrame frame = scene::made::PersonTickAt(2, wish).frame.value();
  scene::Stage stage;
  const scene::Picture picture = stage.Advance(model, frame, scene::made::ClockAt(2), 0.01, {});
  for (const Size& size : kPictureSizes) {
    EXPECT_EQ(Strays(picture, model, frame, scene::made::ClockAt(2), size, "person"), 0)
        << size.width;
  }
}

}  // namespace
}  // namespace footing::render
