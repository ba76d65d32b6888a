#include "clients/view/app/background.h"

#include <boost/asio/post.hpp>
#include <csignal>

#include "common/clock/clock.h"

namespace footing::view {
namespace {

// Four seconds of ticks: a picture that takes longer loses some, which nobody sees.
constexpr std::size_t kQueuedTicks = 1024;

}  // namespace

Background::Background(const Options& options)
    : signals_(io_, SIGINT, SIGTERM),
      updates_(kQueuedTicks),
      feed_(io_, options,
            {[this](scene::Update update) { updates_.Push(std::move(update)); },
             [this](int source, const scene::LinkReport& report) {
               links_[static_cast<std::size_t>(source)]->Write(report);
             }}) {
  for (const scene::LinkReport& report : Feed::InitialReports(options)) {
    links_.push_back(std::make_unique<exchange::Latest<scene::LinkReport>>(report));
  }
  signals_.async_wait([this](const boost::system::error_code& error, int) {
    if (!error) stop_.Raise();
  });
  thread_ = std::thread([this] { RunOnIoThread(); });
}

void Background::RunOnIoThread() {
  feed_.Start();
  io_.run();
}

Background::~Background() {
  boost::asio::post(io_, [this] {
    feed_.Stop();
    signals_.cancel();
    io_.stop();
  });
  thread_.join();
}

void Background::SendToSimulation(v1::Command command) {
  boost::asio::post(io_, [this, command = std::move(command)] { feed_.SendToSimulation(command); });
}

void Background::Drain(scene::Show& show) {
  std::vector<scene::LinkReport>& reports = show.model().links;
  reports.resize(links_.size());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    links_[i]->Refresh();
    reports[i] = links_[i]->Front();
  }
  scene::Update update;
  while (updates_.Pop(update)) show.Take(update, clock::MonotonicNs());
}

}  // namespace footing::view
