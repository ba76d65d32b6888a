#include "daemon/sensor/setup/disk_writer.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

#include "common/runtime/clock.h"

namespace footing::setup {

DiskWriter::DiskWriter(boost::asio::io_context& io, Write write,
                       std::function<void(const std::string& problem)> on_result)
    : io_(io),
      write_(std::move(write)),
      on_result_(std::move(on_result)),
      disk_(1),
      work_(disk_.get_executor()),
      thread_([this] { disk_.run(); }) {}

DiskWriter::~DiskWriter() {
  if (writing_) waiting_.pop_front();
  for (Text& text : waiting_) {
    boost::asio::post(disk_, [this, text = std::move(text)] { write_(text.name, text.content); });
  }
  work_.reset();
  thread_.join();
}

void DiskWriter::Save(const std::string& name, const std::string& content) {
  ++last_save_;
  const auto first = waiting_.begin() + (writing_ ? 1 : 0);
  const auto same =
      std::find_if(first, waiting_.end(), [&](const Text& text) { return text.name == name; });
  if (same != waiting_.end()) {
    same->content = content;
    return;
  }
  waiting_.push_back({name, content, last_save_});
  if (!writing_) WriteNext();
}

std::optional<std::string> DiskWriter::Waiting(const std::string& name) const {
  const auto found = std::find_if(waiting_.rbegin(), waiting_.rend(),
                                  [&](const Text& text) { return text.name == name; });
  return found == waiting_.rend() ? std::nullopt : std::optional(found->content);
}

void DiskWriter::OnWritten(std::function<void(const std::string& problem)> done) {
  waiters_.push_back({last_save_, "", std::move(done)});
  if (waiting_.empty()) {
    boost::asio::post(io_, [this, alive = std::weak_ptr(alive_)] {
      if (!alive.expired()) CallDone();
    });
  }
}

void DiskWriter::WriteNext() {
  writing_ = true;
  auto write = [this, text = waiting_.front(), alive = std::weak_ptr(alive_)] {
    std::string problem = write_(text.name, text.content);
    boost::asio::post(io_, [this, alive, problem = std::move(problem)] {
      if (!alive.expired()) OnResult(problem);
    });
  };
  // On simulated time nothing goes on beside the threads that have their turns.
  if (clock::OwnFollower() != nullptr) return write();
  boost::asio::post(disk_, std::move(write));
}

void DiskWriter::OnResult(const std::string& problem) {
  waiting_.pop_front();
  writing_ = false;
  if (!waiting_.empty()) WriteNext();
  on_result_(problem);
  for (Waiter& waiter : waiters_) {
    if (!problem.empty()) waiter.problem = problem;
  }
  CallDone();
}

void DiskWriter::CallDone() {
  std::uint64_t oldest = last_save_ + 1;
  for (const Text& text : waiting_) oldest = std::min(oldest, text.first_save);
  while (!waiters_.empty() && waiters_.front().save < oldest) {
    const Waiter waiter = std::move(waiters_.front());
    waiters_.pop_front();
    waiter.done(waiter.problem);
  }
}

}  // namespace footing::setup
