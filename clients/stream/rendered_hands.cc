#include "clients/stream/rendered_hands.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <thread>
#include <vector>

#include "clients/stream/feeds.h"
#include "common/body/points.h"
#include "common/runtime/flag.h"
#include "common/frames/netpbm.h"
#include "common/virtual/camera/render.h"
#include "common/virtual/devices/random.h"

namespace footing::stream_client {
namespace {

constexpr double kDemoRateHz = 20;

virtual_camera::Lens ToLens(const sphere::Lens& lens) {
  return {lens.width, lens.height, lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px,
          lens.k1,    lens.k2,     lens.p1,    lens.p2,    lens.k3};
}

/// Scenes become images in its thread.
class Renderer {
 public:
  Renderer(int descriptor, std::uint64_t seed)
      : descriptor_(descriptor),
        ended_(::eventfd(0, EFD_CLOEXEC)),
        random_(seed),
        work_(io_.get_executor()) {
    ::fcntl(descriptor_, F_SETFL, O_NONBLOCK);
    thread_ = std::thread([this] { io_.run(); });
  }

  ~Renderer() {
    ::eventfd_write(ended_, 1);  // The thread may wait for a reader that reads no more.
    work_.reset();
    io_.stop();
    thread_.join();
    ::close(descriptor_);
    ::close(ended_);
  }

  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  void Take(const virtual_camera::Scene& scene, std::int64_t exposed_ns) {
    if (!busy_.RaiseIfLowered()) return;
    boost::asio::post(io_, [this, scene, exposed_ns] {
      RenderOnRenderThread(scene, exposed_ns);
      busy_.Lower();
    });
  }

 private:
  void RenderOnRenderThread(const virtual_camera::Scene& scene, std::int64_t exposed_ns) {
    if (closed_) return;
    const auto mosaic = virtual_camera::Render(scene, random_);
    const std::string image = frames::ToPgm(
        {sphere::PixelFormat::kSgrbg8, mosaic.width, mosaic.height, mosaic.bytes, exposed_ns});
    for (std::size_t at = 0; at < image.size();) {
      const ssize_t written = ::write(descriptor_, image.data() + at, image.size() - at);
      if (written > 0) at += static_cast<std::size_t>(written);
      if (written > 0 || (written < 0 && errno == EINTR)) continue;
      if (written == 0 || errno != EAGAIN || !WaitForReader()) {
        closed_ = true;  // Its reader has gone, or this program ends.
        return;
      }
    }
  }

  /// False when the destructor waits.
  bool WaitForReader() const {
    std::array<pollfd, 2> waited = {{{descriptor_, POLLOUT, 0}, {ended_, POLLIN, 0}}};
    while (::poll(waited.data(), waited.size(), -1) < 0 && errno == EINTR) {
    }
    return (waited[1].revents & POLLIN) == 0;
  }

  const int descriptor_;
  const int ended_;
  noise::Random random_;
  exchange::Flag busy_;
  bool closed_ = false;  // Of the render thread.
  boost::asio::io_context io_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
  std::thread thread_;
};

/// What a sphere shows the simulated camera at a colour of its light: each of three LEDs on the
/// sensor's red, green and blue, whose filters overlap, and ambient light on the white plastic.
Eigen::Vector3d ShownColour(std::uint32_t rgb) {
  Eigen::Matrix3d sensor_dn;  // A column for each LED at its brightest.
  sensor_dn << 150, 20, 12,   //
      22, 150, 30,            //
      12, 30, 150;
  const Eigen::Vector3d light((rgb >> 16) & 0xff, (rgb >> 8) & 0xff, rgb & 0xff);
  return Eigen::Vector3d(16, 15, 17) + sensor_dn * light / 255;
}

/// Where on the body the sphere of that role is.
body::Point SphereOf(const Stage& stage, stream::DeviceRole role) {
  if (role == stream::DeviceRole::kHead) return CapSphere(stage);
  return body::Fist(stage.scene.body, role == stream::DeviceRole::kLeftHand ? 0 : 1);
}

/// A sphere where it is when the row on which it appears is exposed. It rests meanwhile: at
/// the exposure of 1 ms that is meant here, a hand moves by a millimetre.
virtual_camera::Ball BallOn(const Stage& stage, const frames::CameraFile& camera,
                            const virtual_camera::Scene& scene, std::size_t sphere,
                            const body::Point& point, const SphereLights& lights, double t_s) {
  const Eigen::Isometry3d X_CW = camera.X_WC->inverse();
  virtual_camera::Ball ball;
  const auto light = lights.find(camera.spheres[sphere].role);
  ball.colour_dn =
      light == lights.end() ? camera.spheres[sphere].target.colour_dn : ShownColour(light->second);
  ball.radius_m = camera.spheres[sphere].target.radius_m;
  ball.p_C_m = X_CW * PlaceAt(stage, point, t_s);
  if (ball.p_C_m.z() <= 0.1) return ball;  // Behind the camera: not drawn.
  const double row_px = virtual_camera::Project(scene.lens, ball.p_C_m).y();
  ball.p_C_m = X_CW * PlaceAt(stage, point, t_s + virtual_camera::RowTime(scene, row_px));
  return ball;
}

Result<frames::CameraFile> ReadPlacedCamera(const std::string& path) {
  auto camera = frames::ReadCameraFile(path);
  if (!camera) return camera;
  if (!camera->X_WC)
    return InvalidData(path + " does not say where the camera is (position_W_m, rotation_WC)");
  if (camera->format != sphere::PixelFormat::kSgrbg8)
    return InvalidData(path + ", key format: frames are rendered in SGRBG8 only");
  return camera;
}

}  // namespace

Result<Feed> RenderedHandsFeed(std::shared_ptr<const Stage> stage, const std::string& camera_file,
                               const std::string& fifo, std::uint64_t seed) {
  auto read = ReadPlacedCamera(camera_file);
  if (!read) return read.error();
  const auto camera = std::make_shared<const frames::CameraFile>(*std::move(read));
  std::signal(SIGPIPE, SIG_IGN);  // NOLINT: a reader that goes ends the frames, not the program.
  const int descriptor = ::open(fifo.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0)
    return Failure("cannot write frames to " + fifo + ": " + std::string(std::strerror(errno)) +
                   "; make it with mkfifo");
  const auto renderer = std::make_shared<Renderer>(descriptor, seed);
  std::vector<body::Point> points;
  for (const frames::HeldSphere& held : camera->spheres)
    points.push_back(SphereOf(*stage, held.role));
  Feed feed;
  feed.rate_hz = camera->rate_hz;
  feed.frames = [stage, camera, renderer, points](double t_s, std::int64_t exposed_ns,
                                                  const SphereLights& lights) {
    virtual_camera::Scene scene;
    scene.lens = ToLens(camera->lens);
    scene.sensor.readout_s = camera->readout_s;
    scene.sensor.exposure_s = 0.001;
    scene.sensor.read_noise_dn = camera->settings.noise.read_dn;
    scene.sensor.dn_per_electron = camera->settings.noise.dn_per_electron;
    for (std::size_t i = 0; i < camera->spheres.size(); ++i)
      scene.balls.push_back(BallOn(*stage, *camera, scene, i, points[i], lights, t_s));
    renderer->Take(scene, exposed_ns);
  };
  return feed;
}

std::string DemoCameraFile() {
  frames::CameraFile camera;
  camera.rate_hz = kDemoRateHz;
  camera.X_WC = Eigen::Isometry3d::Identity();
  camera.X_WC->linear() << 0, 0, -1, 1, 0, 0, 0, -1, 0;  // Looks along -x of W.
  camera.X_WC->translation() << 2.2, 0, 1.2;
  camera.calibrated = "by construction: of a simulated camera";
  const std::array<Eigen::Vector3d, 2> colours = {{{170, 40, 150}, {40, 170, 160}}};
  for (std::size_t i = 0; i < colours.size(); ++i) {
    frames::HeldSphere held;
    held.role = i == 0 ? stream::DeviceRole::kLeftHand : stream::DeviceRole::kRightHand;
    held.target.colour_dn = colours[i];
    camera.spheres.push_back(held);
  }
  return frames::ToJson(camera);
}

}  // namespace footing::stream_client
