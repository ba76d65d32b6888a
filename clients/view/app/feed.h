#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "clients/view/app/options.h"
#include "clients/view/app/window.h"
#include "clients/view/scene/camera.h"
#include "clients/view/scene/stage.h"
#include "clients/view/scene/update.h"
#include "common/camera/preview.h"
#include "common/net/address.h"
#include "common/net/client.h"
#include "common/net/socket.h"
#include "common/runtime/exchange.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace footing::view {

/// Listens to any number of servers. Everything runs on the io_context's one thread.
class Feed {
 public:
  struct Handlers {
    std::function<void(scene::Update)> on_update;
    std::function<void(int source, const scene::LinkReport&)> on_link;
  };

  Feed(boost::asio::io_context& io, const Options& options, Handlers handlers);

  void Start();
  void Stop();
  /// Sends a command to every live server of that name; a refusal comes back as a note.
  void SendTo(const std::string& server_id, const v1::Command& command);

  /// The sources as they stand before anything has arrived.
  static std::vector<scene::LinkReport> InitialReports(const Options& options);

 private:
  struct Source {
    scene::LinkReport report;
    bool same_host = true;
    std::unique_ptr<transport::Client> client;
  };
  std::unique_ptr<transport::Client> Connect(boost::asio::io_context& io, int source,
                                             const transport::Address& address);
  std::int64_t OffsetOf(const Source& source) const;

  Handlers handlers_;
  std::vector<Source> sources_;
};

/// Receives the preview of footing-camera while it is wanted; dials again every second. Everything
/// runs on the io_context's one thread.
class PreviewLink {
 public:
  using OnChange = std::function<void(const scene::CameraPreview&)>;

  PreviewLink(boost::asio::io_context& io, transport::Address address, OnChange on_change);
  void Start();
  void Stop();

 private:
  void Dial();
  void Read();
  void TakeBytes(std::size_t count);
  void Lose(scene::CameraPreview::State state, const std::string& why);
  void Show(scene::CameraPreview::State state, const std::string& why);

  static constexpr std::size_t kPiece = std::size_t{1} << 16;

  boost::asio::io_context& io_;
  transport::Address address_;
  OnChange on_change_;
  timer::Timer again_;
  std::array<char, kPiece> bytes_{};
  std::optional<transport::Socket> socket_;
  preview::PreviewReader reader_;
  scene::CameraPreview shown_;
  std::shared_ptr<const int> run_;  ///< Token of this run: calls of earlier runs hold another.
};

/// The io thread: receives ticks there and hands them to the render thread through a bounded
/// queue. Ctrl-C and SIGTERM raise a flag.
class Background {
 public:
  explicit Background(const Options& options);
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Render thread: takes in all that has come; a calibration goes on with it.
  void Drain(scene::Show& show, PoseCalibration* calibration);
  /// Sends a command to the servers of that name, from the io thread.
  void SendTo(const std::string& server_id, v1::Command command);
  /// Receives the preview of footing-camera from now on, or no longer.
  void WantPreview(bool wanted);
  bool stop_asked() const { return stop_.raised(); }

 private:
  void RunOnIoThread();

  boost::asio::io_context io_;
  service_manager::ProgramEnd end_;
  exchange::BoundedQueue<scene::Update> updates_;
  std::vector<std::unique_ptr<exchange::Latest<scene::LinkReport>>> links_;
  exchange::Flag stop_;
  exchange::Latest<scene::CameraPreview> preview_;
  Feed feed_;
  PreviewLink preview_link_;
  bool preview_wanted_ = false;
  std::thread thread_;
};

}  // namespace footing::view
