#include "clients/view/app/background.h"

#include <boost/asio/post.hpp>
#include <csignal>
#include <utility>

#include "common/runtime/clock.h"

namespace footing::view {
namespace {

// Four seconds of ticks: a picture that takes longer loses some, which nobody sees.
constexpr std::size_t kQueuedTicks = 1024;
constexpr char kSensors[] = "footingd";

}  // namespace

Background::Background(const Options& options)
    : signals_(io_, SIGINT, SIGTERM),
      updates_(kQueuedTicks),
      feed_(io_, options,
            {[this](scene::Update update) { updates_.Push(std::move(update)); },
             [this](int source, const scene::LinkReport& report) {
               links_[static_cast<std::size_t>(source)]->Write(report);
             }}),
      preview_link_(io_, options.camera.address,
                    [this](const scene::CameraPreview& preview) { preview_.Write(preview); }) {
  for (const scene::LinkReport& report : Feed::InitialReports(options)) {
    links_.push_back(std::make_unique<exchange::Latest<scene::LinkReport>>(report));
  }
  signals_.async_wait([this](const boost::system::error_code& error, int) {
    if (!error) stop_.Raise();
  });
  thread_ = std::thread([this] { RunOnIoThread(); });
  WantPreview(options.camera.corner || options.camera.alone);
}

void Background::RunOnIoThread() {
  feed_.Start();
  io_.run();
}

Background::~Background() {
  boost::asio::post(io_, [this] {
    feed_.Stop();
    preview_link_.Stop();
    signals_.cancel();
    io_.stop();
  });
  thread_.join();
}

void Background::SendTo(const std::string& server_id, v1::Command command) {
  boost::asio::post(
      io_, [this, server_id, command = std::move(command)] { feed_.SendTo(server_id, command); });
}

void Background::WantPreview(bool wanted) {
  if (std::exchange(preview_wanted_, wanted) == wanted) return;
  boost::asio::post(io_, [this, wanted] {
    if (wanted) {
      preview_link_.Start();
    } else {
      preview_link_.Stop();
    }
  });
}

void Background::Drain(scene::Show& show, PoseCalibration* calibration) {
  std::vector<scene::LinkReport>& reports = show.model().links;
  reports.resize(links_.size());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    links_[i]->Refresh();
    reports[i] = links_[i]->Front();
  }
  preview_.Refresh();
  show.model().observed.camera = preview_.Front();
  scene::Update update;
  while (updates_.Pop(update)) {
    const bool of_sensors = reports[static_cast<std::size_t>(update.source)].server_id == kSensors;
    if (calibration != nullptr && of_sensors) calibration->Take(update);
    show.Take(update, clock::MonotonicNs());
  }
  if (calibration != nullptr) {
    calibration->Advance(show.model(),
                         [this](v1::Command command) { SendTo(kSensors, std::move(command)); });
  }
}

}  // namespace footing::view
