#include "clients/stream/simulated_device.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <utility>

#include "common/base/units.h"
#include "common/stream/product_ids.h"
#include "common/virtual/devices/wiimote.h"

namespace footing::stream_client {

using virtual_devices::Report;

namespace {

// Reports of a Wiimote and a Balance Board (wiibrew.org).
constexpr std::uint8_t kStatusRequest = 0x15;
constexpr std::uint8_t kReadRequest = 0x17;
constexpr std::uint8_t kStatusReply = 0x20;
constexpr std::uint8_t kReadReply = 0x21;
constexpr std::uint8_t kAcknowledgement = 0x22;
constexpr std::uint8_t kNothingThere = 0x07;  // In the low half of a read reply's fourth byte.
constexpr std::uint8_t kMoveCalibrationFeature = 0x10;

// A Joy-Con's: packet number and motor in bytes 1 to 9, then subcommand and arguments.
constexpr std::uint8_t kSubcommandRequest = 0x01;
constexpr std::size_t kSubcommandAt = 10;
constexpr std::uint8_t kReadSubcommand = 0x10;

bool IsSubcommand(std::span<const std::uint8_t> output) {
  return output.size() > kSubcommandAt + 5 && output[0] == kSubcommandRequest;
}

/// A request without what it says of the motor: a bit in the second byte of every output report.
Report RequestOf(std::span<const std::uint8_t> output) {
  Report request(output.begin(), output.end());
  if (IsSubcommand(output)) {
    std::fill(request.begin() + 1, request.begin() + kSubcommandAt, 0);
  } else if (request.size() > 1) {
    request[1] &= 0xfe;
  }
  return request;
}

/// A reply repeats the subcommand, and of a read address and size as well.
bool FitsSubcommand(const Report& request, const Report& reply) {
  constexpr std::size_t kReplyAt = 14;
  if (reply[0] != kReadReply || reply.size() <= kReplyAt + 5) return false;
  const std::size_t bytes = request[kSubcommandAt] == kReadSubcommand ? 6 : 1;
  return std::equal(request.begin() + kSubcommandAt,
                    request.begin() + static_cast<std::ptrdiff_t>(kSubcommandAt + bytes),
                    reply.begin() + kReplyAt);
}

bool IsAnswer(std::uint8_t id) {
  return id == kStatusReply || id == kReadReply || id == kAcknowledgement;
}

/// The answer that belongs to a request.
bool Fits(const Report& request, const Report& answer) {
  if (IsSubcommand(request)) return FitsSubcommand(request, answer);
  switch (request[0]) {
    case kStatusRequest:
      return answer[0] == kStatusReply;
    case kReadRequest:
      return answer[0] == kReadReply;
    default:
      return answer[0] == kAcknowledgement && answer.size() > 3 && answer[3] == request[0];
  }
}

Report RefusedRead(std::span<const std::uint8_t> request) {
  Report reply(22, 0);
  reply[0] = kReadReply;
  reply[3] = 0xf0 | kNothingThere;
  if (request.size() > 4) {
    reply[4] = request[3];
    reply[5] = request[4];
  }
  return reply;
}

/// The first of the answers, kept when it is the only one.
template <typename Value>
Value NextOf(std::deque<Value>& answers) {
  Value answer = answers.front();
  if (answers.size() > 1) answers.pop_front();
  return answer;
}

}  // namespace

RecordedDevice::RecordedDevice(virtual_devices::Identity identity, double attaches_s,
                               double detaches_s, const std::vector<RecordedReport>& reports,
                               const std::vector<std::uint8_t>& stored_calibration)
    : identity_(std::move(identity)), attaches_s_(attaches_s), detaches_s_(detaches_s) {
  Learn(reports);
  if (stored_calibration.empty() || identity_.vendor != stream::kVendorSony || !features_.empty())
    return;
  const auto model = identity_.product == stream::kProductZcm2 ? virtual_devices::MoveModel::kZcm2
                                                               : virtual_devices::MoveModel::kZcm1;
  virtual_devices::PsMove move(0, model, stored_calibration);
  constexpr int kMostPieces = 3;
  for (int piece = 0; piece < kMostPieces; ++piece) {
    if (auto feature = move.Feature(kMoveCalibrationFeature, SIZE_MAX)) {
      features_[kMoveCalibrationFeature].push_back(std::move(*feature));
    }
  }
}

void RecordedDevice::Learn(const std::vector<RecordedReport>& reports) {
  /// A request and where its answer is being collected.
  struct Asked {
    Report request;
    std::size_t number = 0;
  };
  std::vector<Asked> open;
  for (const RecordedReport& report : reports) {
    if (report.feature) {
      if (report.to_device || report.bytes.empty()) continue;
      features_[report.bytes[0]].push_back(report.bytes);
    } else if (report.bytes.empty()) {
      continue;
    } else if (report.to_device) {
      Report request = RequestOf(report.bytes);
      // One read at a time, and an acknowledgement is of the newest report of its id.
      std::erase_if(open, [&](const Asked& asked) { return asked.request[0] == request[0]; });
      auto& answers = answers_[request];
      answers.emplace_back();
      open.push_back({std::move(request), answers.size() - 1});
    } else if (!IsAnswer(report.bytes[0])) {
      data_.push_back(report);
    } else {
      const auto asked = std::find_if(open.begin(), open.end(), [&](const Asked& one) {
        return Fits(one.request, report.bytes);
      });
      if (asked == open.end()) {
        // A status of its own accord says that something was plugged or pulled.
        if (report.bytes[0] == kStatusReply) data_.push_back(report);
        continue;
      }
      answers_[asked->request][asked->number].push_back(report.bytes);
      if (report.bytes[0] != kReadReply) open.erase(asked);
    }
  }
  // A request that was lost is asked again: what answered it then answers it at once now.
  for (auto& [request, answers] : answers_) {
    std::erase_if(answers, [](const Answer& answer) { return answer.empty(); });
  }
  std::erase_if(answers_, [](const auto& entry) { return entry.second.empty(); });
}

std::vector<Report> RecordedDevice::HandleOutput(std::int64_t,
                                                 std::span<const std::uint8_t> output) {
  if (output.empty()) return {};
  const auto found = answers_.find(RequestOf(output));
  if (found != answers_.end()) return NextOf(found->second);
  if (output[0] == kReadRequest) return {RefusedRead(output)};
  return {};
}

Report RecordedDevice::Feature(std::uint8_t id, std::size_t size) {
  const auto found = features_.find(id);
  if (found == features_.end()) return {};
  // Pieces come in turn; the host that asks again gets them all again.
  Report feature = found->second.front();
  found->second.pop_front();
  found->second.push_back(feature);
  feature.resize(std::min(size, feature.size()));
  return feature;
}

std::optional<double> RecordedDevice::NextTime() const {
  if (next_ >= data_.size()) return std::nullopt;
  return data_[next_].time_s;
}

Report RecordedDevice::Take() { return data_[next_++].bytes; }

namespace {

/// A recorded device ignores the host's settings.
SimulatedDevice::Shown Show(const RecordedDevice&, std::int64_t) { return {}; }

template <typename Remote>
SimulatedDevice::Shown Show(const Remote& remote, std::int64_t) {
  return {" LEDs " + std::to_string(remote.leds()), remote.rumble()};
}

SimulatedDevice::Shown Show(const virtual_devices::PsMove& move, std::int64_t now_ns) {
  char sphere[32];
  std::snprintf(sphere, sizeof sphere, " sphere #%06x", move.sphere_rgb(now_ns));
  return {sphere, move.rumble(now_ns) != 0};
}

std::vector<Report> Sample(virtual_devices::Wiimote& wiimote, std::int64_t now_ns,
                           const virtual_devices::WiimoteSensors& sensors) {
  return wiimote.Sample(now_ns, sensors);
}

std::vector<Report> Sample(virtual_devices::BalanceBoard& board, std::int64_t,
                           const virtual_devices::CornerForces& forces) {
  const auto report = board.Sample(forces);
  return report ? std::vector<Report>{*report} : std::vector<Report>{};
}

std::vector<Report> Sample(virtual_devices::Joycon& joycon, std::int64_t now_ns,
                           const virtual_devices::JoyconBurst& burst) {
  return joycon.Sample(now_ns, burst);
}

std::vector<Report> Sample(virtual_devices::PsMove& move, std::int64_t now_ns,
                           const virtual_devices::MoveSensors& sensors) {
  return move.Sample(now_ns, sensors);
}

}  // namespace

SimulatedDevice::SimulatedDevice(Device device, stream::DeviceRole role,
                                 const virtual_devices::LinkConfig& link)
    : fresh_(std::move(device)), device_(fresh_), role_(role), link_config_(link), link_(link, 0) {
  Restart();
}

SimulatedDevice::SimulatedDevice(virtual_devices::Wiimote wiimote, WiimoteMotion motion,
                                 stream::DeviceRole role, const virtual_devices::LinkConfig& link)
    : SimulatedDevice(Device(Wiimote{std::move(wiimote), std::move(motion)}), role, link) {}

SimulatedDevice::SimulatedDevice(virtual_devices::BalanceBoard board, CornerForces forces,
                                 stream::DeviceRole role, const virtual_devices::LinkConfig& link)
    : SimulatedDevice(Device(Board{std::move(board), std::move(forces)}), role, link) {}

SimulatedDevice::SimulatedDevice(virtual_devices::PsMove move, MoveMotion motion,
                                 stream::DeviceRole role, const virtual_devices::LinkConfig& link)
    : SimulatedDevice(Device(Move{std::move(move), std::move(motion)}), role, link) {}

SimulatedDevice::SimulatedDevice(virtual_devices::Joycon joycon, JoyconMotion motion,
                                 stream::DeviceRole role, const virtual_devices::LinkConfig& link)
    : SimulatedDevice(Device(Joycon{std::move(joycon),
                                    [motion = std::move(motion)](double t_s) {
                                      constexpr double kSpacingS = 0.005;
                                      virtual_devices::JoyconBurst burst;
                                      burst[0] = motion(t_s - 2 * kSpacingS);
                                      burst[1] = motion(t_s - kSpacingS);
                                      burst[2] = motion(t_s);
                                      return burst;
                                    }}),
                      role, link) {}

SimulatedDevice::SimulatedDevice(RecordedDevice recorded, stream::DeviceRole role)
    : SimulatedDevice(Device(Recorded{std::move(recorded)}), role, {}) {}

const virtual_devices::Identity& SimulatedDevice::identity() const {
  return std::visit(
      [](const auto& felt) -> const auto& { return felt.device.identity(); }, device_);
}

std::vector<Report> SimulatedDevice::HandleOutput(double now_s,
                                                  std::span<const std::uint8_t> output) {
  const std::int64_t now_ns = SecondsToNanoseconds(now_s);
  return std::visit([=](auto& felt) { return felt.device.HandleOutput(now_ns, output); }, device_);
}

Report SimulatedDevice::Feature(std::uint8_t id, std::size_t size) {
  if (auto* recorded = std::get_if<Recorded>(&device_)) return recorded->device.Feature(id, size);
  auto* move = std::get_if<Move>(&device_);
  return move == nullptr ? Report() : move->device.Feature(id, size).value_or(Report());
}

double SimulatedDevice::attaches_s() const {
  const auto* recorded = std::get_if<Recorded>(&device_);
  return recorded == nullptr ? 0 : recorded->device.attaches_s();
}

double SimulatedDevice::detaches_s() const {
  const auto* recorded = std::get_if<Recorded>(&device_);
  return recorded == nullptr ? std::numeric_limits<double>::infinity()
                             : recorded->device.detaches_s();
}

SimulatedDevice::Arrival SimulatedDevice::Next() {
  if (const auto* recorded = std::get_if<Recorded>(&device_)) {
    const double time_s =
        recorded->device.NextTime().value_or(std::numeric_limits<double>::infinity());
    return {time_s, time_s};
  }
  const virtual_devices::LinkModel::Arrival arrival = link_.Next();
  return {NanosecondsToSeconds(arrival.arrives_ns), NanosecondsToSeconds(arrival.sampled_ns)};
}

std::vector<Report> SimulatedDevice::Deliver(double sampled_s) {
  if (auto* recorded = std::get_if<Recorded>(&device_)) return {recorded->device.Take()};
  const bool fresh = sampled_s != held_s_;
  held_s_ = sampled_s;
  return std::visit(
      [=](auto& felt) -> std::vector<Report> {
        if constexpr (requires { felt.motion; }) {
          if (fresh) felt.held = felt.motion(sampled_s);
          return Sample(felt.device, SecondsToNanoseconds(sampled_s), felt.held);
        } else {
          return {};
        }
      },
      device_);
}

void SimulatedDevice::Restart() {
  device_ = fresh_;
  link_ = virtual_devices::LinkModel(link_config_, 0);
  held_s_ = -1;
  shown_ = Show(0);
}

SimulatedDevice::Shown SimulatedDevice::Show(double now_s) const {
  const std::int64_t now_ns = SecondsToNanoseconds(now_s);
  return std::visit([=](const auto& felt) { return stream_client::Show(felt.device, now_ns); },
                    device_);
}

std::optional<std::uint32_t> SimulatedDevice::SphereLight(double now_s) const {
  const auto* move = std::get_if<Move>(&device_);
  if (move == nullptr) return std::nullopt;
  return move->device.sphere_rgb(SecondsToNanoseconds(now_s));
}

std::string SimulatedDevice::Changes(double now_s) {
  const Shown shown = Show(now_s);
  std::string line;
  if (shown.lights != shown_.lights) line += shown.lights;
  if (shown.rumble != shown_.rumble) line += shown.rumble ? " rumble on" : " rumble off";
  shown_ = shown;
  return line.empty() ? line : identity().serial + line;
}

}  // namespace footing::stream_client
