#include "clients/view/render/hud_layout.h"

#include <gtest/gtest.h>

#include <vector>

namespace footing::render {
namespace {

struct NamedBox {
  const char* name;
  Box box;
};

std::vector<NamedBox> All(const HudBoxes& boxes) {
  std::vector<NamedBox> all{{"stamp", boxes.stamp}, {"middle", boxes.middle}};
  if (boxes.character) all.push_back({"character", *boxes.character});
  if (boxes.strips) all.push_back({"strips", *boxes.strips});
  if (boxes.devices) all.push_back({"devices", *boxes.devices});
  if (boxes.interface) all.push_back({"interface", *boxes.interface});
  if (boxes.boards) all.push_back({"boards", *boxes.boards});
  if (boxes.camera) all.push_back({"camera", *boxes.camera});
  return all;
}

bool Overlap(const Box& a, const Box& b) {
  return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

const std::vector<ImVec2> kLayoutSizes{{320, 180},   {400, 600},   {640, 360},   {640, 400},
                                       {800, 600},   {1024, 768},  {1280, 720},  {1280, 1024},
                                       {1920, 1080}, {2560, 1440}, {3440, 1440}, {3840, 2160}};
const HudNeeds kGait{{196, 266}, {190, 550}, {88, 330}, {152, 152}, {150, 236}};
const HudNeeds kPose{{276, 336}, {}, {88, 330}, {}, {150, 236}};
const HudNeeds kBare{{196, 266}, {}, {68, 68}, {}, {}};
const HudNeeds kCamera{{196, 266}, {190, 550}, {88, 330}, {152, 152}, {150, 236}, {250, 350}};

TEST(HudLayout, NoTwoPanelsOverlapAndAllStayInThePicture) {
  for (const ImVec2& size : kLayoutSizes) {
    for (const HudNeeds& needs : {kGait, kPose, kBare, kCamera, HudNeeds{}}) {
      const auto all = All(LayOut(size, HudScale(size, 1), needs));
      for (std::size_t i = 0; i < all.size(); ++i) {
        const Box& box = all[i].box;
        const auto where = [&] {
          return std::string(all[i].name) + " at " + std::to_string(static_cast<int>(size.x)) +
                 " x " + std::to_string(static_cast<int>(size.y));
        };
        EXPECT_GE(box.low.x, 0) << where();
        EXPECT_GE(box.low.y, 0) << where();
        EXPECT_LE(box.high.x, size.x) << where();
        EXPECT_LE(box.low.y, box.high.y) << where();
        if (box.height() > 0) {
          EXPECT_LE(box.high.y, size.y) << where();
        }
        for (std::size_t j = 0; j < i; ++j) {
          EXPECT_FALSE(Overlap(box, all[j].box)) << where() << " and " << all[j].name;
        }
      }
    }
  }
}

TEST(HudLayout, SmallPicturesKeepEveryPanelAndLettersOfTenPixels) {
  const ImVec2 size(640, 400);
  const float scale = HudScale(size, 1);
  EXPECT_GE(12.5f * scale, 10);  // The letters of most lines are 12.5 units high.
  const HudBoxes gait = LayOut(size, scale, kGait);
  EXPECT_TRUE(gait.character && gait.strips && gait.devices && gait.interface && gait.boards);
  const HudBoxes pose = LayOut(size, scale, kPose);
  EXPECT_TRUE(pose.character && pose.devices && pose.boards);
  EXPECT_GT(gait.middle.width(), 0.2f * size.x);  // The figure can still be seen.
}

TEST(HudLayout, ThePreviewIsAtTheBottomOfTheLeftColumnBeforeAllElse) {
  const HudBoxes beside = LayOut({1280, 720}, 1, kCamera);
  ASSERT_TRUE(beside.camera && beside.character);
  EXPECT_FLOAT_EQ(beside.camera->high.y, 702);
  EXPECT_FLOAT_EQ(beside.camera->height(), 250);
  const HudBoxes small = LayOut({640, 400}, 0.8f, kCamera);
  EXPECT_TRUE(small.camera);
  EXPECT_FALSE(small.strips);
  HudNeeds alone;
  alone.camera = {250, 350};
  EXPECT_FLOAT_EQ(LayOut({1280, 720}, 1, alone).camera->height(), 350);
}

TEST(HudLayout, LargePicturesHaveLargeLetters) {
  EXPECT_FLOAT_EQ(HudScale({1280, 720}, 1), 1);
  EXPECT_FLOAT_EQ(HudScale({2560, 1440}, 1), 2);
  EXPECT_FLOAT_EQ(HudScale({3440, 1440}, 1), 2);
  EXPECT_FLOAT_EQ(HudScale({640, 400}, 2), 1.6f);  // A small window on a fine display.
}

TEST(HudLayout, WhatDoesNotFitIsLeftOut) {
  const ImVec2 narrow(360, 600);
  const HudBoxes boxes = LayOut(narrow, HudScale(narrow, 1), kGait);
  EXPECT_TRUE(boxes.character && boxes.strips);
  EXPECT_FALSE(boxes.devices || boxes.boards);
  const ImVec2 low(1280, 200);
  EXPECT_FALSE(LayOut(low, HudScale(low, 1), kGait).boards);
}

}  // namespace
}  // namespace footing::render
