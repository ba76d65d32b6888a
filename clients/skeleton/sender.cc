#include "clients/skeleton/sender.h"

#include <chrono>
#include <string>

#include <boost/asio/io_context.hpp>

#include "common/base/units.h"
#include "common/net/socket.h"
#include "common/runtime/clock.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace footing::skeleton {
namespace {

namespace asio = boost::asio;

class Sender {
 public:
  Sender(const std::vector<ClipFrame>& clip, const SenderOptions& options)
      : clip_(clip), options_(options), socket_(io_), next_(io_) {}

  Result<nlohmann::ordered_json> Run() {
    boost::system::error_code error;
    socket_.open(options_.to.protocol(), error);
    if (!error) socket_.connect(options_.to, error);
    if (error) return Failure("cannot send to UDP: " + transport::MessageOf(error));
    began_ = timer::Now();
    began_ns_ = clock::MonotonicNs();
    SendLater();
    io_.run();
    return nlohmann::ordered_json{
        {"seconds", NanosecondsToSeconds(clock::MonotonicNs() - began_ns_)},
        {"frames", frame_},
        {"packets", packets_},
        {"bytes", bytes_}};
  }

 private:
  /// When a frame is due, since the start.
  std::int64_t DueNs(std::size_t frame) const {
    if (options_.rate_hz > 0)
      return static_cast<std::int64_t>(frame) * PeriodNanoseconds(options_.rate_hz);
    // After its end a clip goes on at its start, a thirtieth of a second later.
    const std::int64_t clip_ns = clip_.back().time_ns + PeriodNanoseconds(30);
    const auto rounds = static_cast<std::int64_t>(frame / clip_.size());
    const std::int64_t at_ns = rounds * clip_ns + clip_[frame % clip_.size()].time_ns;
    return static_cast<std::int64_t>(static_cast<double>(at_ns) / options_.rate_scale);
  }

  bool IsOver() const {
    if (options_.seconds > 0) return DueNs(frame_) > SecondsToNanoseconds(options_.seconds);
    return frame_ == clip_.size();
  }

  void SendLater() {
    if (IsOver()) {
      end_.cancel();
      return;
    }
    next_.At(began_ + std::chrono::nanoseconds(DueNs(frame_)), [this] {
      Send();
      ++frame_;
      SendLater();
    });
  }

  void Send() {
    Skeleton skeleton = clip_[frame_ % clip_.size()].skeleton;
    skeleton.sequence = static_cast<std::int64_t>(frame_);
    skeleton.sent_ns =
        options_.dialect == Dialect::kZillode ? clock::MonotonicNs() - began_ns_ : clock::WallNs();
    for (skeleton.user = 1; skeleton.user <= options_.people; ++skeleton.user) {
      for (const auto& packet : Encode(options_.dialect, options_.dialect_options, skeleton)) {
        boost::system::error_code nobody_listens;  // Yet, or any more.
        bytes_ += socket_.send(asio::buffer(packet), 0, nobody_listens);
        ++packets_;
      }
    }
  }

  const std::vector<ClipFrame>& clip_;
  const SenderOptions& options_;
  asio::io_context io_{1};
  service_manager::ProgramEnd end_{io_, [this] { next_.cancel(); }};
  asio::ip::udp::socket socket_;
  timer::Timer next_;
  timer::TimePoint began_;
  std::int64_t began_ns_ = 0;
  std::size_t frame_ = 0;
  std::uint64_t packets_ = 0, bytes_ = 0;
};

}  // namespace

Result<nlohmann::ordered_json> SendClip(const std::vector<ClipFrame>& clip,
                                        const SenderOptions& options) {
  return Sender(clip, options).Run();
}

using nlohmann::ordered_json;

ordered_json ToJson(const Tracker& tracker, const Cost& cost) {
  const TrackerCounts& counts = tracker.counts();
  const DecoderCounts& decoder = tracker.decoder_counts();
  ordered_json json = {{"seconds", cost.seconds},
                       {"cpu_share", cost.seconds > 0 ? cost.cpu_s / cost.seconds : 0},
                       {"packets", counts.packets},
                       {"bytes", counts.bytes},
                       {"dropped_packets", cost.dropped_packets},
                       {"rejected_packets", counts.rejected_packets},
                       {"messages", decoder.messages},
                       {"unknown_messages", decoder.unknown},
                       {"rejected_joints", decoder.rejected},
                       {"late_joints", decoder.late},
                       {"skeletons", counts.skeletons},
                       {"overtaken_skeletons", counts.overtaken},
                       {"published", cost.published},
                       {"hand_frames", cost.hand_frames},
                       {"dropped_hand_frames", cost.dropped_hand_frames},
                       {"advice", tracker.Advice()},
                       {"people", ordered_json::array()}};
  for (const auto& [user, person] : counts.people) {
    const auto of = [&verdicts = person.verdicts](Verdict verdict) {
      return verdicts[static_cast<std::size_t>(verdict)];
    };
    json["people"].push_back({{"user", user},
                              {"dialect", NameOf(person.dialect)},
                              {"skeletons", person.skeletons},
                              {"joints", person.joints},
                              {"inferred_joints", person.inferred},
                              {"absent_joints", of(Verdict::kAbsent)},
                              {"bone_rejected", of(Verdict::kBone)},
                              {"speed_rejected", of(Verdict::kSpeed)},
                              {"fault_rejected", of(Verdict::kFault)},
                              {"advice", tracker.AdviceOf(user)}});
  }
  if (const auto& camera = tracker.camera()) {
    json["camera"] = {{"x_m", camera->p_W_m.x()},
                      {"y_m", camera->p_W_m.y()},
                      {"z_m", camera->p_W_m.z()},
                      {"yaw_deg", RadiansToDegrees(camera->yaw_rad)},
                      {"pitch_deg", RadiansToDegrees(camera->pitch_rad)},
                      {"roll_deg", RadiansToDegrees(camera->roll_rad)}};
  }
  return json;
}

std::string ToText(const ordered_json& json) {
  std::string text = json["packets"].dump() + " packets, " + json["skeletons"].dump() +
                     " skeletons, " + json["hand_frames"].dump() + " frames of hands sent\n";
  if (const auto advice = json["advice"].get<std::string>(); !advice.empty()) text += advice + "\n";
  for (const auto& person : json["people"]) {
    text += "person " + person["user"].dump() + " (" + person["dialect"].get<std::string>() +
            "): " + person["skeletons"].dump() + " skeletons, " + person["joints"].dump() +
            " joints, " + person["bone_rejected"].dump() + " rejected by bone length, " +
            person["speed_rejected"].dump() + " by speed";
    if (const auto advice = person["advice"].get<std::string>(); !advice.empty())
      text += "; " + advice;
    text += "\n";
  }
  return text;
}

}  // namespace footing::skeleton
