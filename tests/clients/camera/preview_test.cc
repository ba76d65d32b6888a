// Rendered frames, the real finder, and viewers on real sockets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>

#include "clients/camera/preview_server.h"
#include "common/camera/preview.h"
#include "common/virtual/camera/render.h"

namespace footing::camera {
namespace {

namespace rendered = virtual_camera;
using testing::HasSubstr;

const Eigen::Vector3d kMagenta(170, 40, 150), kCyan(30, 150, 160);

frames::CameraFile TwoSpheres() {
  frames::CameraFile camera;
  camera.spheres = {{stream::DeviceRole::kLeftHand, {kMagenta}},
                    {stream::DeviceRole::kRightHand, {kCyan}}};
  return camera;
}

/// The left hand's sphere at 1.5 m; the right hand's is not there.
rendered::Scene OneSphere() {
  rendered::Scene scene;
  rendered::Ball ball;
  ball.p_C_m = {-0.3, 0.1, 1.5};
  ball.colour_dn = kMagenta;
  scene.balls = {ball};
  return scene;
}

SeenFrame Look(const rendered::Scene& scene) {
  noise::Random random(5);
  const rendered::Mosaic mosaic = rendered::Render(scene, random);
  const frames::CameraFile camera = TwoSpheres();
  SeenFrame seen;
  seen.frame = {sphere::PixelFormat::kSgrbg8, mosaic.width, mosaic.height, mosaic.bytes, {}};
  sphere::Finder finder(camera.lens, camera.Targets(), camera.settings);
  seen.found = finder.Find(seen.frame.View());
  seen.verdicts.resize(camera.spheres.size());
  return seen;
}

const SeenFrame& Ordinary() {
  static const SeenFrame seen = Look(OneSphere());
  return seen;
}

preview::Picture Painted(const SeenFrame& seen) { return PreviewPainter(TwoSpheres()).Paint(seen); }

TEST(PreviewPicture, ShowsASphereWhereTheFinderFoundItInItsColour) {
  const preview::Picture picture = Painted(Ordinary());
  ASSERT_EQ(picture.width, 320);
  ASSERT_EQ(picture.height, 240);
  ASSERT_EQ(picture.rgb.size(), 3u * 320 * 240);
  ASSERT_EQ(picture.spheres.size(), 2u);
  const preview::Sphere& left = picture.spheres[0];
  EXPECT_EQ(left.role, stream::DeviceRole::kLeftHand);
  EXPECT_EQ(left.sight, preview::Sight::kSeen);
  // x / z f + c: -0.2 * 540 + 319.5 and 0.0667 * 540 + 239.5; 22.5 mm at 1.53 m are 8 px.
  EXPECT_NEAR(left.circle.u_px, 211.5, 1);
  EXPECT_NEAR(left.circle.v_px, 275.5, 1);
  EXPECT_NEAR(left.circle.radius_px, 8.1, 0.5);
  EXPECT_NEAR(left.range_m, std::sqrt(0.09 + 0.01 + 2.25), 0.03);
  const std::size_t at = 3 * (137 * 320 + 105);  // Half of the camera's pixels.
  EXPECT_GT(picture.rgb[at], 180);
  EXPECT_LT(picture.rgb[at + 1], 150);
  EXPECT_GT(picture.rgb[at + 2], 160);
}

TEST(PreviewPicture, SaysWhyASphereIsNotSeen) {
  EXPECT_EQ(Painted(Ordinary()).spheres[1].sight, preview::Sight::kNothing);
  rendered::Scene scene = OneSphere();
  scene.shapes = {{rendered::Shape::Kind::kRectangle, {500, 100}, {60, 4}, 0, kCyan}};
  SeenFrame seen = Look(scene);
  const preview::Sphere bar = Painted(seen).spheres[1];
  EXPECT_EQ(bar.sight, preview::Sight::kOther);
  EXPECT_NEAR(bar.circle.u_px, 500, 3);
  EXPECT_NEAR(bar.circle.v_px, 100, 3);
  // The same light, refused before, is not shown twice: only its place is.
  seen.verdicts[1].refused = {{{500, 100}, 70}};
  const preview::Picture refused = Painted(seen);
  EXPECT_EQ(refused.spheres[1].sight, preview::Sight::kNothing);
  ASSERT_EQ(refused.refused.size(), 1u);
  EXPECT_EQ(refused.refused[0].role, stream::DeviceRole::kRightHand);
  seen.verdicts[1].is_switching = true;
  EXPECT_EQ(Painted(seen).spheres[1].sight, preview::Sight::kChecking);
  seen.verdicts[0].accepts = false;
  EXPECT_EQ(Painted(seen).spheres[0].sight, preview::Sight::kChecking);
}

TEST(PreviewPicture, ALargeFrameIsReducedFurther) {
  SeenFrame seen = Ordinary();
  seen.frame.width = 1280;
  seen.frame.height = 960;
  seen.frame.bytes.assign(std::size_t{1280} * 960, 64);
  const preview::Picture picture = Painted(seen);
  EXPECT_EQ(picture.width, 320);
  EXPECT_EQ(picture.height, 240);
  EXPECT_EQ(picture.rgb[0], 128);  // 255 sqrt(64 / 255).
}

/// A viewer, as another process would be.
class Client {
 public:
  explicit Client(const std::string& path) : socket_(socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::strncpy(name.sun_path, path.c_str(), sizeof(name.sun_path) - 1);
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
  }
  ~Client() { close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Takes what is there; false at the end of the stream.
  bool Read() {
    std::array<char, 65536> bytes;
    for (;;) {
      const ssize_t got = recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (got < 0) return true;
      if (got == 0) return false;
      reader_.Add({bytes.data(), static_cast<std::size_t>(got)});
      for (;;) {
        auto next = reader_.Next();
        EXPECT_TRUE(next) << next.error().message;
        if (!next || !*next) break;
        last = **next;
        ++messages;
      }
    }
  }
  void Say(const std::string& what) const {
    EXPECT_EQ(send(socket_, what.data(), what.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(what.size()));
  }

  preview::Message last;
  int messages = 0;

 private:
  int socket_;
  preview::PreviewReader reader_;
};

std::uint64_t NumberOf(const preview::Message& message) {
  const auto* const picture = std::get_if<preview::Picture>(&message);
  return picture == nullptr ? 0 : picture->number;
}

class PreviewServerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("preview_test." + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    Open(kNever);
  }
  void TearDown() override {
    server_.reset();
    std::filesystem::remove_all(folder_);
  }
  static constexpr std::int64_t kNever = std::int64_t{1} << 60;  // Whatever the machine is at.
  void Open(std::int64_t cut_off_ns) {
    auto opened = PreviewServer::Open(Address(), TwoSpheres(), cut_off_ns);
    ASSERT_TRUE(opened) << opened.error().message;
    server_ = std::move(opened).value();
  }
  std::string Path() const { return (folder_ / "camera.sock").string(); }
  transport::Address Address() const { return transport::ParseAddress("unix:" + Path()).value(); }

  /// Frames go by, a tenth of a second each on the tracking's clock, until `done`.
  void TrackUntil(const std::function<bool()>& done) {
    for (int i = 0; i < 20'000; ++i) {
      now_ns_ += 100'000'000;
      if (server_->Wants(now_ns_)) {
        server_->Next() = Ordinary();
        server_->Next().number = ++shown_;
        server_->Show(now_ns_);
      }
      if (done()) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    FAIL() << "nothing came of " << shown_ << " pictures";
  }

  std::filesystem::path folder_;
  std::unique_ptr<PreviewServer> server_;
  std::int64_t now_ns_ = 0;
  std::uint64_t shown_ = 0;
};

TEST_F(PreviewServerTest, AViewerGetsPicturesAndNobodyElseCan) {
  EXPECT_FALSE(server_->Wants(1'000'000'000'000));  // Nobody watches.
  struct stat status {};
  ASSERT_EQ(stat(Path().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0660u);
  Client client(Path());
  TrackUntil([&] { return client.Read() && client.messages >= 3; });
  const auto& picture = std::get<preview::Picture>(client.last);
  EXPECT_EQ(picture.spheres.at(0).sight, preview::Sight::kSeen);
  EXPECT_EQ(picture.width, 320);
}

TEST_F(PreviewServerTest, NoMorePicturesThanItsRate) {
  Client client(Path());
  TrackUntil([&] { return client.Read() && client.messages >= 1; });
  EXPECT_FALSE(server_->Wants(now_ns_));
  EXPECT_FALSE(server_->Wants(now_ns_ + 80'000'000));  // 1 / 12 s is 83 ms.
  EXPECT_TRUE(server_->Wants(now_ns_ + 84'000'000));
}

TEST_F(PreviewServerTest, AViewerThatReadsNothingMissesPicturesAndHoldsNobodyUp) {
  Client idle(Path()), client(Path());
  TrackUntil([&] { return client.Read() && client.messages >= 20; });
  // One picture of 230 kB waits in the program; the socket's buffer holds another, or part of it.
  const std::uint64_t until = shown_;
  TrackUntil([&] { return client.Read() && idle.Read() && NumberOf(idle.last) > until; });
  EXPECT_LE(idle.messages, 6);  // Those and perhaps two new ones.
}

TEST_F(PreviewServerTest, AViewerThatReadsNothingForLongIsCutOff) {
  server_.reset();
  Open(30'000'000);
  Client idle(Path());
  // Nothing is wanted any more once it has lost its place.
  TrackUntil([&] { return shown_ > 0 && !server_->Wants(now_ns_ + 1'000'000'000); });
  TrackUntil([&] { return !idle.Read(); });
}

TEST_F(PreviewServerTest, WhoSpeaksIsCutOffAndTheOthersAreNot) {
  Client client(Path());
  {
    Client hostile(Path());
    hostile.Say(std::string(100'000, 'x'));
    bool cut = false;
    TrackUntil([&] { return (cut = cut || !hostile.Read()); });
  }
  client.messages = 0;
  TrackUntil([&] { return client.Read() && client.messages >= 2; });
}

TEST_F(PreviewServerTest, OneViewerTooManyIsToldSo) {
  std::vector<std::unique_ptr<Client>> clients;
  for (std::size_t i = 0; i < PreviewServer::kMostViewers; ++i)
    clients.push_back(std::make_unique<Client>(Path()));
  TrackUntil([&] {
    bool all = true;
    for (const auto& client : clients) all = client->Read() && client->messages > 0 && all;
    return all;
  });
  Client late(Path());
  TrackUntil([&] { return !late.Read(); });
  ASSERT_EQ(late.messages, 1);
  EXPECT_THAT(std::get<preview::Refusal>(late.last).why, HasSubstr("4 viewers"));
  clients.pop_back();
  // Its place is free as soon as the program has seen that it left.
  TrackUntil([&] {
    Client next(Path());
    TrackUntil([&] { return !next.Read() || next.messages > 0; });
    return std::holds_alternative<preview::Picture>(next.last);
  });
}

TEST_F(PreviewServerTest, ALastViewerLeavesAndAnotherComes) {
  for (int i = 0; i < 3; ++i) {
    {
      Client client(Path());
      TrackUntil([&] { return client.Read() && client.messages > 0; });
    }
    TrackUntil([&] { return !server_->Wants(now_ns_ + 1'000'000'000); });
  }
}

TEST_F(PreviewServerTest, OnlyAUnixSocketOfItsOwnIsTaken) {
  const auto tcp =
      PreviewServer::Open(transport::ParseAddress("tcp:127.0.0.1:0").value(), TwoSpheres());
  ASSERT_FALSE(tcp);
  EXPECT_EQ(tcp.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(tcp.error().message, HasSubstr("this host alone"));
  const auto second = PreviewServer::Open(Address(), TwoSpheres());
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message, HasSubstr("in use"));
  server_.reset();
  EXPECT_FALSE(std::filesystem::exists(Path()));
  Open(kNever);
}

}  // namespace
}  // namespace footing::camera
