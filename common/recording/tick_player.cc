#include "common/recording/tick_player.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/runtime/clock.h"
#include "common/recording/shift_stamps.h"

namespace footing::playback {
namespace {

/// From the last tick to the end, so that it gets to those who listen.
constexpr auto kAfterLast = std::chrono::milliseconds(300);

}  // namespace

TickPlayer::TickPlayer(boost::asio::io_context& io, const recording::RecordedSession& session,
                       std::vector<std::string> names, Handlers handlers)
    : timer_(io), names_(std::move(names)), handlers_(std::move(handlers)) {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    std::vector<const recording::RecordedTick*> ticks;
    for (const recording::RecordedServer& server : session.servers()) {
      if (server.name != names_[i]) continue;
      for (const recording::RecordedTick& tick : server.ticks) ticks.push_back(&tick);
    }
    Schedule(i, ticks);
  }
  std::stable_sort(due_.begin(), due_.end(),
                   [](const Due& a, const Due& b) { return a.time_ns < b.time_ns; });
}

/// A tick is due at its time, but never after a later one: the snapshot that a recorder begins with
/// has the time of its connection and comes first.
void TickPlayer::Schedule(std::size_t server,
                          const std::vector<const recording::RecordedTick*>& ticks) {
  const std::size_t first = due_.size();
  for (const recording::RecordedTick* tick : ticks) due_.push_back({tick->host_ns, server, tick});
  for (std::size_t i = due_.size(); i > first + 1; --i) {
    due_[i - 2].time_ns = std::min(due_[i - 2].time_ns, due_[i - 1].time_ns);
  }
}

double TickPlayer::duration_s() const {
  return due_.empty() ? 0 : 1e-9 * static_cast<double>(due_.back().time_ns - due_[0].time_ns);
}

void TickPlayer::Start() {
  start_ = timer::Now();
  if (!due_.empty()) shift_ns_ = clock::MonotonicNs() - due_.front().time_ns;
  PlayNext();
}

void TickPlayer::PlayNext() {
  if (next_ >= due_.size()) return End();
  const Due& due = due_[next_];
  timer_.expires_at(start_ + std::chrono::nanoseconds(due.time_ns - due_.front().time_ns));
  timer_.async_wait([this, &due](const boost::system::error_code& error) {
    if (error) return;
    Result<v1::Tick> tick = recording::ReadTick(*due.tick);
    if (!tick) return handlers_.on_end(tick.error());
    ShiftStamps(*tick, shift_ns_);
    tick->set_host_ns(due.time_ns + shift_ns_);
    ++next_;
    handlers_.on_tick(due.server, *tick);
    PlayNext();
  });
}

void TickPlayer::End() {
  timer_.expires_after(kAfterLast);
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error) handlers_.on_end({});
  });
}

}  // namespace footing::playback
