#include "clients/stream/dialer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>

#include "common/runtime/clock.h"
#include "common/net/device_link.h"
#include "common/runtime/log.h"
#include "common/runtime/timer.h"
#include "common/base/units.h"
#include "common/wire/wire.h"
#include "footing/v1/device.pb.h"

namespace footing::stream_client {

class Dialer::Implementation : public std::enable_shared_from_this<Dialer::Implementation> {
 public:
  Implementation(boost::asio::io_context& io, DialerOptions options, Plan plan,
                 std::function<void()> on_end)
      : options_(std::move(options)),
        duration_s_(plan.duration_s),
        on_end_(std::move(on_end)),
        devices_(std::move(plan.devices)),
        fresh_sources_(std::move(plan.feeds)),
        silences_(std::move(plan.silences)),
        link_(io, {.to = options_.to,
                   .on_open = [this] { OnOpen(); },
                   .on_message = [this](const v1::DeviceEnvelope& message) { OnMessage(message); },
                   .on_refused = [this](const auto& message) { refused_.insert(message.slot()); },
                   .on_close = [this] { StopClocks(); }}) {
    sequences_.assign(devices_.size(), 0);
    // One for each, and one for the end.
    for (std::size_t i = 0; i < devices_.size() + fresh_sources_.size() + 1; ++i)
      clocks_.push_back(std::make_unique<timer::Timer>(io));
  }

  void Dial() { link_.Start(); }

  void Stop(const std::string& reason) {
    stopped_ = true;
    StopClocks();
    for (std::size_t slot = 0; slot < devices_.size(); ++slot) SendDetach(slot, reason);
    link_.Stop(reason);
  }

  bool has_attached() const { return has_attached_; }
  bool all_refused() const { return !devices_.empty() && refused_.size() >= devices_.size(); }

 private:
  void OnOpen() {
    has_attached_ = true;
    refused_.clear();
    const std::string what = devices_.empty()
                                 ? std::to_string(fresh_sources_.size()) + " simulated sources"
                                 : std::to_string(devices_.size()) + " simulated devices";
    log::Info("attached " + what + " to " + options_.to.Text());
    start_ns_ = clock::MonotonicNs();
    start_ = timer::Now();
    for (std::size_t slot = 0; slot < devices_.size(); ++slot) {
      devices_[slot].Restart();
      if (devices_[slot].attaches_s() > 0) {
        AttachLater(slot);
      } else {
        SendAttach(slot);
        Schedule(slot);
      }
    }
    ScheduleEnd();
    sources_ = fresh_sources_;
    sent_.assign(sources_.size(), 0);
    for (std::size_t i = 0; i < sources_.size(); ++i) ScheduleSource(i);
  }

  void StopClocks() {
    for (auto& timer : clocks_) timer->cancel();
  }

  void AttachLater(std::size_t slot) {
    At(slot, devices_[slot].attaches_s() / options_.rate_scale, [this, slot] {
      SendAttach(slot);
      Schedule(slot);
    });
  }

  /// A device that has nothing more to send stays until it is lost.
  void DetachLater(std::size_t slot) {
    const double time_s = devices_[slot].detaches_s() / options_.rate_scale;
    if (std::isinf(time_s)) return;
    At(slot, time_s, [this, slot] { SendDetach(slot, "lost in the recording"); });
  }

  void SendDetach(std::size_t slot, const std::string& reason) {
    v1::DeviceEnvelope envelope;
    envelope.mutable_detach()->set_slot(static_cast<std::uint32_t>(slot));
    envelope.mutable_detach()->set_reason(reason);
    link_.Send(envelope);
  }

  /// Does something at a time of the motion, by one of the clocks: of a slot, a source or the end.
  void At(std::size_t slot, double time_s, std::function<void()> action) {
    clocks_[slot]->expires_at(start_ + std::chrono::nanoseconds(SecondsToNanoseconds(time_s)));
    clocks_[slot]->async_wait(
        [weak = weak_from_this(), action = std::move(action)](boost::system::error_code error) {
          const auto self = weak.lock();
          if (self && !error && self->link_.open() && !self->stopped_) action();
        });
  }

  void SendAttach(std::size_t slot) {
    const virtual_devices::Identity& identity = devices_[slot].identity();
    v1::DeviceEnvelope envelope;
    v1::DeviceAttach& attach = *envelope.mutable_attach();
    attach.set_slot(static_cast<std::uint32_t>(slot));
    attach.set_bus(identity.bus);
    attach.set_vendor(identity.vendor);
    attach.set_product(identity.product);
    attach.set_name(identity.name);
    attach.set_serial(identity.serial);
    attach.set_role(static_cast<v1::DeviceRole>(devices_[slot].role()));
    link_.Send(envelope);
  }

  void OnMessage(const v1::DeviceEnvelope& envelope) {
    if (!envelope.has_output() || envelope.output().slot() >= devices_.size()) return;
    const std::string& bytes = envelope.output().report();
    const std::size_t slot = envelope.output().slot();
    const std::int64_t now_ns = clock::MonotonicNs();
    const double now_s = NanosecondsToSeconds(now_ns - start_ns_);
    if (IsSilent(slot, now_s)) return;
    SimulatedDevice& device = devices_[slot];
    if (envelope.output().channel() == v1::DeviceOutput::CHANNEL_FEATURE_GET) {
      if (bytes.empty()) return;
      const auto id = static_cast<std::uint8_t>(bytes[0]);
      SendReport(slot, device.Feature(id, envelope.output().size()), now_ns, true);
      return;
    }
    const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
    for (const auto& report : device.HandleOutput(now_s, {first, bytes.size()})) {
      SendReport(slot, report, now_ns);
    }
    if (const std::string changes = device.Changes(now_s); !changes.empty()) log::Info(changes);
  }

  void Schedule(std::size_t slot) {
    SimulatedDevice::Arrival next = devices_[slot].Next();
    next.arrives_s /= options_.rate_scale;
    next.sampled_s /= options_.rate_scale;
    if (std::isinf(next.arrives_s)) return DetachLater(slot);
    At(slot, next.arrives_s, [this, slot, next] { Deliver(slot, next); });
  }

  bool IsSilent(std::size_t slot, double time_s) const {
    return std::any_of(silences_.begin(), silences_.end(), [&](const Silence& silence) {
      return silence.device == slot && silence.Covers(time_s);
    });
  }

  /// A recording may end with its devices silent: the end does not wait for their reports.
  void ScheduleEnd() {
    if (duration_s_ <= 0) return;
    At(clocks_.size() - 1, duration_s_, [this] { IsOver(duration_s_); });
  }

  /// The motion has come to its end, which is reported once.
  bool IsOver(double time_s) {
    if (duration_s_ <= 0 || time_s < duration_s_) return false;
    if (!ended_) on_end_();
    ended_ = true;
    return true;
  }

  void Deliver(std::size_t slot, const SimulatedDevice::Arrival& arrival) {
    if (IsOver(arrival.arrives_s)) return;
    for (const auto& report : devices_[slot].Deliver(arrival.sampled_s)) {
      if (IsSilent(slot, arrival.arrives_s)) continue;
      SendReport(slot, report, start_ns_ + SecondsToNanoseconds(arrival.sampled_s));
    }
    Schedule(slot);
  }

  SphereLights Lights() const {
    const double now_s = NanosecondsToSeconds(clock::MonotonicNs() - start_ns_);
    SphereLights lights;
    for (const SimulatedDevice& device : devices_)
      if (const auto rgb = device.SphereLight(now_s)) lights[device.role()] = *rgb;
    return lights;
  }

  void ScheduleSource(std::size_t index) {
    const double due_s = static_cast<double>(sent_[index]) / sources_[index].rate_hz;
    At(devices_.size() + index, due_s + sources_[index].late_s,
       [this, index, due_s] { SendDue(index, due_s); });
  }

  /// Sends the value at `due_s`; its age is how late this is.
  void SendDue(std::size_t index, double due_s) {
    if (devices_.empty() && IsOver(due_s)) return;
    Feed& feed = sources_[index];
    if (feed.frames) {
      feed.frames(due_s, start_ns_ + SecondsToNanoseconds(due_s), Lights());
      ++sent_[index];
      return ScheduleSource(index);
    }
    const std::int64_t now_ns = clock::MonotonicNs();
    const std::int64_t age_ns =
        std::max<std::int64_t>(0, now_ns - start_ns_ - SecondsToNanoseconds(due_s));
    v1::DeviceEnvelope envelope;
    if (feed.hands) {
      stream::HandFrame frame = feed.hands(due_s);
      frame.age_ns = age_ns;
      frame.sent_ns = now_ns;
      *envelope.mutable_hand_frame() = wire::ToProto(frame);
    } else if (feed.contacts) {
      stream::ContactFrame frame = feed.contacts(due_s);
      frame.age_ns = age_ns;
      frame.sent_ns = now_ns;
      *envelope.mutable_contact_frame() = wire::ToProto(frame);
    } else {
      stream::ReferenceFrame frame = feed.reference(due_s);
      frame.age_ns = age_ns;
      frame.sent_ns = now_ns;
      *envelope.mutable_reference_frame() = wire::ToProto(frame);
    }
    link_.Send(envelope);
    ++sent_[index];
    ScheduleSource(index);
  }

  void SendReport(std::size_t slot, const virtual_devices::Report& report, std::int64_t true_ns,
                  bool feature = false) {
    v1::DeviceEnvelope envelope;
    v1::DeviceInputReport& input = *envelope.mutable_input_report();
    input.set_slot(static_cast<std::uint32_t>(slot));
    input.set_sequence(++sequences_[slot]);
    input.set_report(report.data(), report.size());
    input.set_true_ns(true_ns);
    input.set_feature(feature);
    link_.Send(envelope);
  }

  const DialerOptions options_;
  const double duration_s_;  // Of motion; 0 goes on until stopped.
  const std::function<void()> on_end_;
  std::vector<SimulatedDevice> devices_;
  const std::vector<Feed> fresh_sources_;
  const std::vector<Silence> silences_;
  std::vector<Feed> sources_;
  std::vector<std::uint64_t> sent_;  // How often each was.
  std::vector<std::unique_ptr<timer::Timer>> clocks_;
  timer::TimePoint start_;
  std::vector<std::uint64_t> sequences_;
  std::set<std::uint32_t> refused_;  ///< Slots, on the present connection.
  device_link::DeviceLink link_;
  std::int64_t start_ns_ = 0;
  bool has_attached_ = false;
  bool stopped_ = false;
  bool ended_ = false;
};

Dialer::Dialer(boost::asio::io_context& io, DialerOptions options, Plan plan,
               std::function<void()> on_end)
    : implementation_(std::make_shared<Implementation>(io, std::move(options), std::move(plan),
                                                       std::move(on_end))) {}

Dialer::~Dialer() = default;

void Dialer::Start() { implementation_->Dial(); }
bool Dialer::has_attached() const { return implementation_->has_attached(); }
bool Dialer::all_refused() const { return implementation_->all_refused(); }
void Dialer::Stop(const std::string& reason) { implementation_->Stop(reason); }

}  // namespace footing::stream_client
