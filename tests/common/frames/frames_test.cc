#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/frames/camera_file.h"
#include "tests/common/temporary_folder.h"

namespace footing::frames {
namespace {

Frame SmallFrame() {
  Frame frame{sphere::PixelFormat::kSgrbg8, 32, 34, {}, 123456789};
  for (int i = 0; i < 32 * 34; ++i) frame.bytes.push_back(static_cast<std::uint8_t>(i));
  return frame;
}

TEST(Netpbm, TakesImagesOneAfterTheOtherInAnyPieces) {
  const std::string text = ToPgm(SmallFrame()) + ToPgm(SmallFrame());
  NetpbmReader reader;
  int images = 0;
  for (const char c : text) {
    reader.Add({&c, 1});
    const auto frame = reader.Next();
    ASSERT_TRUE(frame) << frame.error().message;
    if (!*frame) continue;
    ++images;
    EXPECT_EQ((*frame)->bytes, SmallFrame().bytes);
    EXPECT_EQ((*frame)->time_ns, 123456789);
    EXPECT_EQ((*frame)->height, 34);
  }
  EXPECT_EQ(images, 2);
  EXPECT_TRUE(reader.empty());
}

TEST(Netpbm, TakesTheMosaicsColoursOfAColourImage) {
  std::string text = "P6 32 32 255\n";
  for (int i = 0; i < 32 * 32; ++i) text += std::string("\x0a\x14\x1e", 3);  // 10, 20, 30.
  NetpbmReader reader;
  reader.Add(text);
  const auto frame = reader.Next();
  ASSERT_TRUE(frame && *frame);
  // Green and red in the first row, blue and green in the second.
  EXPECT_EQ((*frame)->bytes[0], 20);
  EXPECT_EQ((*frame)->bytes[1], 10);
  EXPECT_EQ((*frame)->bytes[32], 30);
  EXPECT_EQ((*frame)->bytes[33], 20);
}

TEST(Netpbm, RefusesWhatIsNoImage) {
  for (const char* text : {"P4 32 32 255\n", "GIF89a", "P5 x 3", "P5 31 32 255\n",
                           "P5 32 99999 255\n", "P5 32 32 65535\n", "P5 -4 32 255\n"}) {
    NetpbmReader reader;
    reader.Add(text);
    EXPECT_FALSE(reader.Next()) << text;
  }
  NetpbmReader endless;
  endless.Add("P5 #" + std::string(5000, 'x'));
  EXPECT_FALSE(endless.Next());
}

constexpr char kLeast[] = R"({"spheres": [{"role": "left_hand", "colour_dn": [170, 40, 150]}]})";

TEST(CameraFile, ComesBackAsItWasWritten) {
  auto camera = ParseCameraFile(kLeast, "test");
  ASSERT_TRUE(camera) << camera.error().message;
  camera->lens.k1 = -0.1;
  camera->settings.profile.limb = 0.2;
  camera->X_WC = Eigen::Isometry3d::Identity();
  camera->X_WC->translation() << 1, 2, 0.5;
  const auto again = ParseCameraFile(ToJson(*camera), "test");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(ToJson(*again), ToJson(*camera));
  EXPECT_EQ(again->lens.k1, -0.1);
  ASSERT_TRUE(again->X_WC);
  EXPECT_EQ(again->X_WC->translation().y(), 2);
  EXPECT_NEAR(again->RowTime(479) - again->RowTime(0), again->readout_s, 1e-12);
}

TEST(CameraFile, TakesAPoseAndKeepsTheRest) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("eye.json");
  std::ofstream(path)
      << R"({"fx_px": 612, "spheres": [{"role": "left_hand", "colour_dn": [9, 90, 9]}]})";
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
  X_WC.linear() << 0, 0, -1, 1, 0, 0, 0, -1, 0;
  X_WC.translation() << 2, 0, 1;
  std::filesystem::permissions(path, std::filesystem::perms(0640));
  ASSERT_TRUE(StorePose(path, X_WC, "8 marks, 1 mm"));
  EXPECT_EQ(std::filesystem::status(path).permissions(), std::filesystem::perms(0640));
  const auto camera = ReadCameraFile(path);
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_TRUE(camera->X_WC->isApprox(X_WC, 1e-12));
  EXPECT_EQ(camera->calibrated, "8 marks, 1 mm");
  EXPECT_EQ(camera->lens.fx_px, 612);
  EXPECT_EQ(camera->lens.fy_px, 540);
  ASSERT_TRUE(StorePose(path, Eigen::Isometry3d::Identity(), "again"));
  EXPECT_TRUE(ReadCameraFile(path)->X_WC->isApprox(Eigen::Isometry3d::Identity(), 1e-12));
  // A file that is no camera file is not written into.
  std::ofstream(folder.Path("other.json")) << "{}";
  EXPECT_FALSE(StorePose(folder.Path("other.json"), X_WC, ""));
  // Where the file beside it cannot be written the reason is the system's.
  std::filesystem::create_directories(path + ".new/full");
  const auto refused = StorePose(path, X_WC, "");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "cannot write " + path + ": File exists");
}

TEST(CameraFile, TakesCalibratedSpheresAndKeepsTheRest) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("eye.json");
  std::ofstream(path) << R"({"fx_px": 612, "blur_px": 2})";
  EXPECT_FALSE(ReadCameraFile(path));  // Nothing to look for yet.
  auto camera = ReadUncalibratedCamera(path);
  ASSERT_TRUE(camera) << camera.error().message;
  camera->settings.profile.blur_px = 0.9;
  camera->spheres = {{stream::DeviceRole::kLeftHand, {{150, 40, 130}, 0.03}, 0xff00c8}};
  ASSERT_TRUE(StoreSpheres(path, *camera));
  const auto again = ReadCameraFile(path);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->lens.fx_px, 612);
  EXPECT_EQ(again->settings.profile.blur_px, 0.9);
  ASSERT_EQ(again->spheres.size(), 1u);
  EXPECT_EQ(again->spheres[0].led_rgb, 0xff00c8u);
  EXPECT_EQ(again->spheres[0].target.radius_m, 0.03);
  EXPECT_EQ(again->spheres[0].target.colour_dn, Eigen::Vector3d(150, 40, 130));
  // Where there is no file, one begins.
  ASSERT_TRUE(ReadUncalibratedCamera(folder.Path("new.json")));
  ASSERT_TRUE(StoreSpheres(folder.Path("new.json"), *camera));
  EXPECT_EQ(ReadCameraFile(folder.Path("new.json"))->spheres[0].led_rgb, 0xff00c8u);
  camera->lens.k1 = -0.1;
  ASSERT_TRUE(StoreLens(path, *camera));
  EXPECT_EQ(ReadCameraFile(path)->lens.k1, -0.1);
  EXPECT_EQ(ReadCameraFile(path)->spheres.size(), 1u);
  // A lens without spheres is the start of a file, too.
  ASSERT_TRUE(StoreLens(folder.Path("lens.json"), CameraFile()));
  EXPECT_TRUE(ReadUncalibratedCamera(folder.Path("lens.json")));
  EXPECT_FALSE(ReadCameraFile(folder.Path("lens.json")));
  std::ofstream(path)
      << R"({"spheres": [{"role": "left_hand", "colour_dn": [9, 90, 9], "led": "red"}]})";
  EXPECT_NE(ReadCameraFile(path).error().message.find("key led: must be a colour"),
            std::string::npos);
}

TEST(CameraFile, ErrorsNameFileKeyAndWhatIsAllowed) {
  const auto problem = [](const std::string& more) {
    std::string text = kLeast;
    text.replace(1, 0, more);
    const auto camera = ParseCameraFile(text, "eye.json");
    return camera ? "" : camera.error().message;
  };
  EXPECT_EQ(problem("\"focal\": 3, "), "eye.json, key focal: unknown key");
  EXPECT_EQ(problem("\"rate_hz\": 0, "),
            "eye.json, key rate_hz: must be a number from 1.0 to 1000.0");
  EXPECT_EQ(problem("\"format\": \"MJPEG\", "), "eye.json, key format: must be SGRBG8 or YUYV");
  EXPECT_NE(problem("\"distortion\": [1, 2], ").find("must be 5 numbers"), std::string::npos);
  EXPECT_NE(problem("\"distortion\": [-4, 0, 0, 0, 0], ").find("cannot be undone"),
            std::string::npos);
  EXPECT_NE(problem("\"position_W_m\": [1, 2, 3], ").find("belong together"), std::string::npos);
  EXPECT_FALSE(ParseCameraFile("{}", "x"));
  EXPECT_FALSE(ParseCameraFile("[1", "x"));
  EXPECT_FALSE(
      ParseCameraFile(R"({"spheres": [{"role": "left_hand", "colour_dn": [9, 9, 9]}]})", "x"));
  const std::pair<const char*, bool> roles[] = {{"head", true}, {"trunk", false}, {"tail", false}};
  for (const auto& [role, fits] : roles) {
    const std::string spheres =
        R"({"spheres": [{"role": ")" + std::string(role) + R"(", "colour_dn": [9, 90, 9]}]})";
    EXPECT_EQ(ParseCameraFile(spheres, "x").ok(), fits) << role;
  }
  EXPECT_NE(problem("\"rate_hz\": 60, \"readout_s\": 0.02, ").find("time between frames"),
            std::string::npos);
}

TEST(CameraFile, SpheresThatCouldBeMistakenForEachOtherAreRefused) {
  const auto problem = [](const char* role, const char* colour) {
    const auto read = ParseCameraFile(
        std::string(R"({"spheres": [{"role": "left_hand", "colour_dn": [170, 40, 150]}, )") +
            R"({"role": ")" + role + R"(", "colour_dn": )" + colour + "}]}",
        "eye.json");
    return read ? "" : read.error().message;
  };
  EXPECT_EQ(problem("right_hand", "[40, 170, 160]"), "");
  EXPECT_EQ(problem("left_hand", "[40, 170, 160]"),
            "eye.json, spheres 1 and 2 both have the role left_hand");
  // Dimmer and in more white light, but of the same hue.
  EXPECT_NE(problem("right_hand", "[120, 55, 110]").find("spheres 1 and 2: their colours are 0"),
            std::string::npos);
  EXPECT_NE(problem("right_hand", "[170, 40, 110]").find("degrees of hue apart"),
            std::string::npos);
}

TEST(FrameFolder, ReadsFramesInTheOrderOfTheirNames) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("");
  EXPECT_FALSE(FramesOf(path));
  for (const char* name : {"b.pgm", "a.pgm"})
    std::ofstream(path + "/" + name) << ToPgm(SmallFrame());
  std::ofstream(path + "/notes.txt") << "x";
  const auto files = FramesOf(path);
  ASSERT_TRUE(files);
  ASSERT_EQ(files->size(), 2u);
  EXPECT_TRUE(files->front().ends_with("a.pgm"));
  EXPECT_TRUE(ReadFrame(files->front(), 32, 34));
  std::ofstream(path + "/c.yuyv") << std::string(100, 'x');
  EXPECT_FALSE(ReadFrame(path + "/c.yuyv", 32, 34));
  EXPECT_FALSE(FramesOf(path + "/nothing"));
}

}  // namespace
}  // namespace footing::frames
