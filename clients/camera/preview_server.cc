#include "clients/camera/preview_server.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include <sys/resource.h>
#include <unistd.h>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>

#include "common/runtime/clock.h"
#include "common/runtime/log.h"

namespace footing::camera {
namespace {

constexpr int kMostWidth = 320;
constexpr double kColourShare = 0.25;  // Share of a sphere's chroma, as in the finder.

using Levels = std::array<std::uint8_t, 256>;

/// A mosaic has the sensor's linear values, which a screen shows too dark; YUYV has a screen's own.
Levels LevelsOf(sphere::PixelFormat format) {
  Levels levels{};
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double share = static_cast<double>(i) / 255;
    const double shown = format == sphere::PixelFormat::kSgrbg8 ? std::sqrt(share) : share;
    levels[i] = static_cast<std::uint8_t>(std::lround(255 * shown));
  }
  return levels;
}

preview::Circle ToCircle(const Eigen::Vector2d& centre_px, double radius_px) {
  return {static_cast<float>(centre_px.x()), static_cast<float>(centre_px.y()),
          static_cast<float>(radius_px)};
}

preview::Circle CircleOf(const sphere::Blob& blob) {
  const int quads = std::max(blob.right - blob.left, blob.bottom - blob.top) + 1;
  return ToCircle(2 * blob.centre + Eigen::Vector2d(0.5, 0.5), quads);
}

bool IsRefused(const preview::Circle& light, const std::vector<sphere::Circle>& refused) {
  return std::any_of(refused.begin(), refused.end(), [&](const sphere::Circle& place) {
    return (place.centre_px - Eigen::Vector2d(light.u_px, light.v_px)).norm() < place.radius_px;
  });
}

}  // namespace

void PreviewPainter::PaintPixels(const SeenFrame& seen, preview::Picture& picture) const {
  const int step = (quads_.width + kMostWidth - 1) / kMostWidth;
  picture.width = quads_.width / step;
  picture.height = quads_.height / step;
  const Levels levels = LevelsOf(seen.frame.format);
  const std::vector<std::int16_t>* const planes[] = {&quads_.red, &quads_.green, &quads_.blue};
  picture.rgb.reserve(std::size_t{3} * static_cast<std::size_t>(picture.width) *
                      static_cast<std::size_t>(picture.height));
  for (int v = 0; v < picture.height; ++v) {
    for (int u = 0; u < picture.width; ++u) {
      for (const auto* plane : planes) {
        int sum = 0;
        for (int row = v * step; row < (v + 1) * step; ++row)
          for (int column = u * step; column < (u + 1) * step; ++column)
            sum += (*plane)[static_cast<std::size_t>(row * quads_.width + column)];
        picture.rgb.push_back(
            levels[static_cast<std::size_t>(std::clamp(sum / (step * step), 0, 255))]);
      }
    }
  }
}

preview::Sphere PreviewPainter::SightOf(const SeenFrame& seen, std::size_t sphere) const {
  preview::Sphere shown;
  shown.role = spheres_[sphere].role;
  const LightVerdict& verdict = seen.verdicts[sphere];
  if (const auto& found = seen.found[sphere]) {
    shown.sight = verdict.accepts ? preview::Sight::kSeen : preview::Sight::kChecking;
    shown.confidence = static_cast<float>(found->confidence);
    shown.range_m = static_cast<float>(found->p_C_m.norm());
    shown.is_saturated = found->is_saturated;
    shown.is_occluded = found->is_occluded;
    shown.circle = ToCircle(found->centre_px, found->radius_px);
    return shown;
  }
  if (verdict.is_switching) {
    shown.sight = preview::Sight::kChecking;
    return shown;
  }
  const auto blobs = sphere::FindBlobs(quads_, sphere::Whole(seen.frame.View()),
                                       spheres_[sphere].target.colour_dn, kColourShare);
  double best = 0;
  for (const sphere::Blob& blob : blobs) {
    const preview::Circle circle = CircleOf(blob);
    if (blob.score <= best || IsRefused(circle, verdict.refused)) continue;
    best = blob.score;
    shown.sight = preview::Sight::kOther;
    shown.circle = circle;
  }
  return shown;
}

preview::Picture PreviewPainter::Paint(const SeenFrame& seen) {
  sphere::ToQuads(seen.frame.View(), quads_);
  preview::Picture picture;
  picture.number = seen.number;
  picture.exposed_ns = seen.exposed_ns;
  picture.camera_width = seen.frame.width;
  picture.camera_height = seen.frame.height;
  picture.has_pose = seen.has_pose;
  picture.simulated = seen.simulated;
  PaintPixels(seen, picture);
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    picture.spheres.push_back(SightOf(seen, i));
    for (const sphere::Circle& place : seen.verdicts[i].refused)
      picture.refused.push_back({spheres_[i].role, ToCircle(place.centre_px, place.radius_px)});
  }
  return picture;
}

namespace {

using boost::system::error_code;

constexpr std::chrono::milliseconds kLookEvery(10);
constexpr std::int64_t kPeriodNs = static_cast<std::int64_t>(1e9 / PreviewServer::kRateHz);
constexpr int kNice = 10;  // The tracking goes first.

}  // namespace

/// One connection: at most one picture waits to be written.
class PreviewServer::Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  explicit Viewer(transport::Socket socket) : socket_(std::move(socket)) {
    transport::Prepare(socket_);
  }

  void Start() {
    // It has nothing to say: what comes is its end.
    socket_.plain().async_read_some(
        boost::asio::buffer(said_),
        [self = shared_from_this()](const error_code&, std::size_t) { self->Close(); });
  }
  void Send(std::shared_ptr<const std::string> message, std::int64_t now_ns) {
    if (message_ || closed_) return;
    message_ = std::move(message);
    since_ns_ = now_ns;
    boost::asio::async_write(socket_.plain(), boost::asio::buffer(*message_),
                             [self = shared_from_this()](const error_code& error, std::size_t) {
                               self->message_.reset();
                               if (error) self->Close();
                             });
  }
  /// Without waiting: a socket that was just opened takes a short message.
  void Refuse(const std::string& why) {
    const std::string message = preview::EncodeRefusal(why);
    const boost::asio::const_buffer buffer = boost::asio::buffer(message);
    error_code ignored;
    socket_.WriteSome({&buffer, 1}, ignored);
    Close();
  }
  void Close() {
    if (!std::exchange(closed_, true)) socket_.Close();
  }

  bool is_free() const { return !message_ && !closed_; }
  /// Closed, or has not taken its picture for long.
  bool IsLost(std::int64_t now_ns, std::int64_t cut_off_ns) const {
    return closed_ || (message_ && now_ns - since_ns_ > cut_off_ns);
  }

 private:
  transport::Socket socket_;
  std::array<char, 16> said_{};
  std::shared_ptr<const std::string> message_;
  std::int64_t since_ns_ = 0;
  bool closed_ = false;
};

Result<std::unique_ptr<PreviewServer>> PreviewServer::Open(const transport::Address& address,
                                                           const frames::CameraFile& camera,
                                                           std::int64_t cut_off_ns) {
  if (address.kind != transport::Address::Kind::kUnix)
    return UsageError("the preview cannot listen on " + address.Text() +
                      ": it is for this host alone; use unix:PATH, or none");
  std::unique_ptr<PreviewServer> server(new PreviewServer(camera, cut_off_ns));
  PreviewServer* const own = server.get();
  auto listener = transport::Listener::Open(
      server->io_, address, [own](transport::Socket socket) { own->Admit(std::move(socket)); });
  if (!listener) return listener.error();
  server->listener_ = std::move(listener).value();
  server->thread_ = std::thread([own] {
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);  // Without it, it works as well.
    own->io_.run();
  });
  return server;
}

PreviewServer::~PreviewServer() {
  boost::asio::post(io_, [this] {
    listener_.reset();
    for (const auto& viewer : viewers_) viewer->Close();
    viewers_.clear();
    look_.cancel();
    io_.stop();
  });
  if (thread_.joinable()) thread_.join();
}

bool PreviewServer::Wants(std::int64_t now_ns) const {
  return watched_.raised() && now_ns - shown_ns_ >= kPeriodNs;
}

void PreviewServer::Show(std::int64_t now_ns) {
  seen_.Publish();
  shown_ns_ = now_ns;
}

void PreviewServer::Admit(transport::Socket socket) {
  auto viewer = std::make_shared<Viewer>(std::move(socket));
  if (viewers_.size() >= kMostViewers) {
    viewer->Refuse("footing-camera already has " + std::to_string(kMostViewers) +
                   " viewers; close one of them");
    return;
  }
  viewer->Start();
  viewers_.push_back(std::move(viewer));
  if (viewers_.size() > 1) return;
  watched_.Raise();
  Look();
}

/// Sends the newest frame to all viewers that have taken the one before, while there are any.
void PreviewServer::Look() {
  const std::int64_t now_ns = clock::MonotonicNs();
  std::erase_if(viewers_, [&](const std::shared_ptr<Viewer>& viewer) {
    if (!viewer->IsLost(now_ns, cut_off_ns_)) return false;
    viewer->Close();
    return true;
  });
  if (viewers_.empty()) return watched_.Lower();
  const bool any_free = std::any_of(viewers_.begin(), viewers_.end(),
                                    [](const auto& viewer) { return viewer->is_free(); });
  if (seen_.Refresh() && any_free) {
    const auto message =
        std::make_shared<const std::string>(preview::Encode(painter_.Paint(seen_.Front())));
    for (const auto& viewer : viewers_) viewer->Send(message, now_ns);
  }
  look_.After(kLookEvery, [this] { Look(); });
}

}  // namespace footing::camera
