#include "daemon/sensor/devices/hid_search.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <utility>

#include "common/runtime/clock.h"
#include "common/stream/product_ids.h"

namespace footing::devices {
namespace {

using SearchOutcome = HidOpening::Outcome;

constexpr int kSoonMs = 50;
constexpr int kSlowlyMs = 1000;
constexpr int kWithMonitorMs = 5000;
constexpr std::int64_t kNewNs = 1'000'000'000;

// As systemd/70-footing.rules.
constexpr const char* kUdevRule =
    "KERNEL==\"hidraw*\", KERNELS==\"0005:057E:*|000[35]:054C:03D5.*|000[35]:054C:0C5E.*\", "
    "GROUP=\"footing\", MODE=\"0660\"";

/// What to say of a node that stays shut; empty when there is nothing to say.
std::string Trouble(const HidOpening& opening) {
  const std::string node = opening.identity.place + " (" + opening.identity.name + ")";
  switch (opening.outcome) {
    case SearchOutcome::kDenied:
      return "cannot open " + node + ": " + opening.reason +
             "; put this line into /etc/udev/rules.d/70-footing.rules, join the group footing and "
             "reconnect the device: " +
             kUdevRule;
    case SearchOutcome::kInUse:
      return node +
             " belongs to another footingd; stop that one, or run this one with --source "
             "stream:ADDRESS only";
    case SearchOutcome::kUnidentified:
      return node + " has no serial; reconnect the device";
    case SearchOutcome::kFailed:
      return "cannot open " + node + ": " + opening.reason + "; reconnect the device";
    case SearchOutcome::kOpen:
    case SearchOutcome::kNobodyThere:
      break;
  }
  return "";
}

}  // namespace

HidSearch::HidSearch(std::function<void()> wake)
    : wake_(std::move(wake)),
      event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      thread_([this] { Run(); }) {}

HidSearch::~HidSearch() {
  stop_.Raise();
  eventfd_write(event_, 1);
  thread_.join();
  close(event_);
}

void HidSearch::Close(std::string path, HidHandle device) {
  closed_.Push({std::move(path), std::move(device)});
  eventfd_write(event_, 1);
}

void HidSearch::Run() {
  while (!stop_.raised()) {
    const std::int64_t now_ns = clock::MonotonicNs();
    heartbeat_.Beat(now_ns);
    Look(now_ns);
    int pause_ms = PauseMs(now_ns);
    if (pause_ms == kWithMonitorMs && monitor_.descriptor() < 0) pause_ms = kSlowlyMs;
    pollfd events[] = {{event_, POLLIN, 0}, {monitor_.descriptor(), POLLIN, 0}};
    poll(events, 2, pause_ms);
    eventfd_t ignored = 0;
    eventfd_read(event_, &ignored);
    if (monitor_.Clear()) changed_ns_ = clock::MonotonicNs();
  }
}

int HidSearch::PauseMs(std::int64_t now_ns) const {
  // A node whose attributes are not all there yet is not listed.
  if (changed_ns_ != 0 && now_ns - changed_ns_ < kNewNs) return kSoonMs;
  int pause_ms = kWithMonitorMs;
  for (const auto& [path, waiting] : waiting_) {
    pause_ms = kSlowlyMs;
    if (now_ns - waiting.since_ns < kNewNs) return kSoonMs;
  }
  return pause_ms;
}

void HidSearch::Look(std::int64_t now_ns) {
  Closed closed;
  while (closed_.Pop(closed)) {
    closed.device.reset();
    open_paths_.erase(closed.path);
  }
  std::set<std::string> seen;
  for (const HidNode& node : monitor_.Nodes()) {
    if (!stream::IsKnownDevice(node.vendor, node.product) || open_paths_.contains(node.path))
      continue;
    seen.insert(node.path);
    Open(node, now_ns);
  }
  std::erase_if(waiting_, [&seen](const auto& one) { return !seen.contains(one.first); });
}

void HidSearch::Open(const HidNode& node, std::int64_t now_ns) {
  HidOpening opening = OpenHid(node);
  if (opening.outcome != SearchOutcome::kOpen) {
    const bool is_new = waiting_.try_emplace(node.path, Waiting{now_ns, false}).second;
    Waiting& waiting = waiting_[node.path];
    if (is_new || waiting.said || now_ns - waiting.since_ns < kNewNs) return;
    waiting.said = true;
    if (const std::string line = Trouble(opening); !line.empty()) Say(line);
    return;
  }
  Found found;
  found.identity = std::move(opening.identity);
  found.device = std::move(opening.device);
  if (!found_.Push(std::move(found))) return;
  waiting_.erase(node.path);
  open_paths_.insert(node.path);
  wake_();
}

void HidSearch::Say(const std::string& line) {
  Found found;
  found.trouble = line;
  found_.Push(std::move(found));
  wake_();
}

}  // namespace footing::devices
