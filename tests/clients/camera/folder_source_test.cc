#include <gtest/gtest.h>
#include <unistd.h>

#include <boost/asio/steady_timer.hpp>
#include <filesystem>
#include <fstream>

#include "clients/camera/source.h"
#include "common/frames/netpbm.h"

namespace footing::camera {
namespace {

TEST(FolderSource, DeliversNothingOnceItIsStoppedHoweverLateItsFramesAre) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("folder_source_test." + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  frames::Frame frame{
      sphere::PixelFormat::kSgrbg8, 640, 480, std::vector<std::uint8_t>(640 * 480, 20), {}};
  std::ofstream(folder / "0.pgm", std::ios::binary) << frames::ToPgm(frame);
  boost::asio::io_context io;
  auto source = OpenFolder(io, folder.string(), {}, true);
  ASSERT_TRUE(source) << source.error().message;
  // Both timers are over before the loop looks: the first one's handler runs first.
  boost::asio::steady_timer limit(io, std::chrono::seconds(-1));
  limit.async_wait([&](boost::system::error_code) { (*source)->Stop(); });
  int frames = 0;
  (*source)->Start(
      [&](const frames::Frame&, std::int64_t) {
        if (++frames > 3) io.stop();
      },
      [](const Result<void>&) {});
  io.run();
  EXPECT_EQ(frames, 0);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace footing::camera
