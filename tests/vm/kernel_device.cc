#include <poll.h>
#include <signal.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/virtual/devices/noise.h"
#include "tests/vm/made_device.h"
#include "tests/vm/ramp.h"
#include "tests/vm/uhid_node.h"

namespace footing::vm {
namespace {

struct Options {
  std::string kind = "wiimote";
  std::uint64_t seed = 1;
  double seconds = 0;         ///< 0: until SIGTERM.
  double status_every_s = 0;  ///< 0: never unasked.
  double unplug_at_s = 0;     ///< 0: never.
  double away_s = 0;          ///< 0: it never comes back.
  int times = 1;
  double loss = 0;
  bool trace = false;
};

constexpr double kLateMs = 5;

std::int64_t Nanoseconds(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

/// A device's life in the kernel. Samples keep to the clock: late ones are sent at once, none is
/// left out, and how late the worst one was is told, since it is this machine's doing.
class Life {
 public:
  explicit Life(const Options& options)
      : options_(options),
        node_({[this] { starts_ns_.push_back(clock::MonotonicNs()); },
               [this](std::span<const std::uint8_t> report) { Answer(report); },
               [this](std::uint8_t id) {
                 ++features_;
                 return device_ ? device_->Feature(id) : std::nullopt;
               }}),
        begin_ns_(clock::MonotonicNs()),
        next_sample_ns_(begin_ns_),
        next_status_ns_(begin_ns_ + Nanoseconds(options.status_every_s)),
        next_change_ns_(begin_ns_ + Nanoseconds(options.unplug_at_s)),
        random_(options.seed) {}

  void Run(const volatile sig_atomic_t& stop) {
    Plug();
    const std::int64_t end_ns = begin_ns_ + Nanoseconds(options_.seconds);
    while (!stop && (options_.seconds == 0 || clock::MonotonicNs() < end_ns)) {
      std::int64_t now_ns = clock::MonotonicNs();
      const std::int64_t wait_ns = std::max<std::int64_t>(0, next_sample_ns_ - now_ns);
      pollfd events = {node_.descriptor(), POLLIN, 0};
      const timespec wait = {0, wait_ns};
      if (ppoll(&events, 1, &wait, nullptr) > 0) node_.HandleEvent();
      now_ns = clock::MonotonicNs();
      ChangeWhenDue(now_ns);
      if (now_ns >= next_sample_ns_) Sample(now_ns);
    }
    if (device_) node_.Unplug();
  }

  nlohmann::json Summary() const {
    return {{"kind", options_.kind},
            {"serial", serial_},
            {"samples", samples_},
            {"inputs", Counts(inputs_)},
            {"outputs", Counts(outputs_)},
            {"foreign_modes", foreign_modes_},
            {"features", features_},
            {"starts_ns", starts_ns_},
            {"lost", lost_},
            {"foreign_commands", foreign_commands_},
            {"unplugs_ns", unplugs_ns_},
            {"late_worst_ms", late_worst_ms_},
            {"late_samples", late_samples_}};
  }

 private:
  using CountById = std::map<std::uint8_t, std::uint64_t>;

  static nlohmann::json Counts(const CountById& counts) {
    nlohmann::json json = nlohmann::json::object();
    for (const auto& [id, count] : counts) {
      char name[3];
      std::snprintf(name, sizeof(name), "%02x", id);
      json[name] = count;
    }
    return json;
  }

  void Plug() {
    device_ = MakeDevice(options_.kind, options_.seed);
    serial_ = device_->identity().serial;
    period_ns_ = device_->period_ns();
    node_.Plug(device_->identity(), device_->descriptor());
  }

  void Send(const MadeDevice::Reports& reports) {
    for (const virtual_devices::Report& report : reports) {
      ++inputs_[report[0]];
      Trace("->", report);
      node_.Send(report);
    }
  }

  /// Every report but data.
  void Trace(const char* way, std::span<const std::uint8_t> report) const {
    if (!options_.trace || (report[0] >= 0x30 && report[0] <= 0x3f)) return;
    std::fprintf(stderr, "%10.4f %s", static_cast<double>(clock::MonotonicNs()) * 1e-9, way);
    for (const std::uint8_t byte : report.first(std::min<std::size_t>(report.size(), 12))) {
      std::fprintf(stderr, " %02x", byte);
    }
    std::fprintf(stderr, "\n");
  }

  void Answer(std::span<const std::uint8_t> report) {
    if (report.empty() || !device_) return;
    Trace("<-", report);
    ++outputs_[report[0]];
    // footingd asks for continuous reports only; it is the kernel's driver that does not.
    if (report[0] == 0x12 && report.size() > 1 && (report[1] & 0x04) == 0) ++foreign_modes_;
    if (report[0] == 0x01 && report.size() > 10) {
      // The kernel's driver of the Switch's controllers sets up with zeros for the motor; footingd
      // always sends what stops it, 00 01 40 40. Only its subcommands get lost.
      const bool foreign = report[3] == 0;
      foreign_commands_ += foreign ? 1 : 0;
      if (!foreign && random_.Uniform() < options_.loss) {
        ++lost_;
        return;
      }
    }
    Send(device_->HandleOutput(clock::MonotonicNs(), report));
  }

  void Sample(std::int64_t now_ns) {
    const double late_ms = static_cast<double>(now_ns - next_sample_ns_) * 1e-6;
    late_worst_ms_ = std::max(late_worst_ms_, late_ms);
    late_samples_ += late_ms > kLateMs ? 1 : 0;
    if (device_) Send(device_->Sample(now_ns, samples_));
    ++samples_;
    next_sample_ns_ += period_ns_;
    if (device_ && options_.status_every_s > 0 && now_ns >= next_status_ns_) {
      Send(device_->Status());
      next_status_ns_ += Nanoseconds(options_.status_every_s);
    }
  }

  void ChangeWhenDue(std::int64_t now_ns) {
    if (options_.unplug_at_s <= 0 || now_ns < next_change_ns_) return;
    if (device_ && static_cast<int>(unplugs_ns_.size()) < options_.times) {
      unplugs_ns_.push_back(now_ns);
      device_.reset();
      node_.Unplug();
      next_change_ns_ = now_ns + Nanoseconds(options_.away_s);
    } else if (!device_ && options_.away_s > 0) {
      Plug();
      next_change_ns_ = now_ns + Nanoseconds(options_.unplug_at_s);
    }
  }

  const Options options_;
  UhidNode node_;
  std::unique_ptr<MadeDevice> device_;  ///< Null while it is away.
  std::string serial_;
  std::int64_t begin_ns_;
  std::int64_t next_sample_ns_;
  std::int64_t next_status_ns_;
  std::int64_t next_change_ns_;
  std::uint64_t samples_ = 0;
  CountById inputs_;   ///< To the kernel.
  CountById outputs_;  ///< From footingd and from the kernel's driver.
  std::int64_t period_ns_ = kSamplePeriodNs;
  std::uint64_t foreign_modes_ = 0;
  noise::Random random_;
  std::uint64_t lost_ = 0;
  std::uint64_t foreign_commands_ = 0;  ///< From the kernel's driver, to a Joy-Con.
  std::uint64_t features_ = 0;          ///< Feature reports asked for.
  std::vector<std::int64_t> starts_ns_;
  std::vector<std::int64_t> unplugs_ns_;
  double late_worst_ms_ = 0;
  std::uint64_t late_samples_ = 0;
};

volatile sig_atomic_t stop_asked = 0;

int Run(int argc, char** argv) {
  Options options;
  auto app = cli::NewApp("kernel_device", "A made device in the kernel, through /dev/uhid.",
                         "  kernel_device --kind board --seed 2 --seconds 30\n"
                         "  kernel_device --unplug-at 3 --replug-after 1 --times 5");
  app->add_option("--kind", options.kind, "Which device")->check(CLI::IsMember(Kinds()));
  app->add_option("--seed", options.seed, "Which device of its kind; its serial too");
  app->add_option("--seconds", options.seconds, "Its life; 0: until SIGTERM");
  app->add_option("--lose", options.loss,
                  "Share of footingd's subcommands to a Joy-Con that get lost");
  app->add_option("--status-every", options.status_every_s, "Status reports that nobody asked for");
  app->add_option("--unplug-at", options.unplug_at_s, "Goes after so many seconds");
  app->add_option("--replug-after", options.away_s, "Comes back after so many seconds");
  app->add_flag("--trace", options.trace, "Every report but data on standard error");
  app->add_option("--times", options.times, "Goes so often");
  if (const auto code = cli::Parse(*app, argc, argv)) return *code;
  struct sigaction action {};
  action.sa_handler = [](int) { stop_asked = 1; };
  sigaction(SIGTERM, &action, nullptr);
  Life life(options);
  life.Run(stop_asked);
  std::cout << life.Summary().dump() << std::endl;
  return 0;
}

}  // namespace
}  // namespace footing::vm

int main(int argc, char** argv) { return footing::vm::Run(argc, argv); }
