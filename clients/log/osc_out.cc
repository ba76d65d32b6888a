#include "clients/log/osc_out.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <span>
#include <utility>

#include <Eigen/Geometry>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>

#include "clients/log/export_bodies.h"
#include "common/base/osc.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/net/client.h"
#include "common/net/socket.h"
#include "common/runtime/clock.h"
#include "common/runtime/service_manager.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/motion/motion.h"
#include "common/wire/wire.h"

namespace footing::log_client {
namespace {

using osc::Argument;

/// The longest leg of the biped as it is usually set up: a longer one is drawn straight.
constexpr double kBipedLegM = 1.15;

/// States of /VMC/Ext/OK.
enum Calibration : std::int32_t { kWaiting = 1, kCalibrating = 2, kCalibrated = 3 };

float Float(double value) { return static_cast<float>(value); }

/// Messages in bundles that fit into a datagram each.
std::vector<std::string> Bundles(const std::vector<std::string>& messages) {
  std::vector<std::string> packets;
  std::size_t first = 0, bytes = 0;
  const auto close = [&](std::size_t end) {
    if (end == first) return;
    packets.push_back(osc::WriteBundle({}, std::span(messages).subspan(first, end - first)));
    first = end;
    bytes = 0;
  };
  constexpr std::size_t kHeadBytes = 16, kLengthBytes = 4;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const std::size_t more = kLengthBytes + messages[i].size();
    if (kHeadBytes + bytes + more > kMostOscBytes) close(i);
    bytes += more;
  }
  close(messages.size());
  return packets;
}

std::string Pose(const char* address, const std::string& name, const Eigen::Vector3d& p,
                 const Eigen::Quaterniond& q) {
  const Argument arguments[] = {std::string_view(name), Float(p.x()), Float(p.y()), Float(p.z()),
                                Float(q.x()),           Float(q.y()), Float(q.z()), Float(q.w())};
  return osc::WriteMessage(address, arguments);
}

/// W's axes in Unity's, which are left-handed: x right, y up, z ahead.
Eigen::Vector3d ToUnity(const Eigen::Vector3d& p) { return {-p.y(), p.z(), p.x()}; }
Eigen::Quaterniond ToUnity(const Eigen::Quaterniond& q) {
  return Eigen::Quaterniond(q.w(), q.y(), -q.z(), -q.x());
}

std::string VmcState(std::int32_t calibration) {
  const Argument arguments[] = {std::int32_t{1}, calibration, std::int32_t{0}, std::int32_t{1}};
  return osc::WriteMessage("/VMC/Ext/OK", arguments);
}

std::string VmcTime(double time_s) {
  const Argument arguments[] = {Float(time_s)};
  return osc::WriteMessage("/VMC/Ext/T", arguments);
}

}  // namespace

void OscEncoder::Take(const v1::Skeletons& skeletons) {
  skeletons_.clear();
  for (const v1::Skeleton& one : skeletons.skeletons()) skeletons_[one.character()] = one;
  body_.reset();
  biped_.reset();
  if (skeletons_.empty()) return;
  biped_ = BipedPerson::Of(skeletons.skeletons(0), kBipedLegM);
  links_ = biped_ ? biped_->Skeleton() : skeletons_.begin()->second;
}

std::vector<std::string> OscEncoder::Encode(const v1::CharacterFrame& frame) {
  return format_ == OscFormat::kVmc ? EncodeVmc(frame) : EncodePlain(frame);
}

std::vector<std::string> OscEncoder::EncodeVmc(const v1::CharacterFrame& frame) {
  if (frame.characters_size() == 0 || skeletons_.empty()) return {};
  const v1::CharacterFrame person = biped_ ? biped_->Frame(frame) : frame;
  const v1::Character& character = person.characters(0);
  if (!character.body().calibrated()) {
    const bool begun = character.body().calibration_progress() > 0;
    return Bundles({VmcState(begun ? kCalibrating : kWaiting), VmcTime(frame.time_s())});
  }
  if (character.links_size() != links_.links_size()) return {};
  if (!body_) {
    auto skeleton = SkeletonOf(links_, character);
    if (!skeleton) return {};
    auto bones = motion::HumanBones(*skeleton);
    if (!bones) return {};
    body_ = std::move(skeleton).value();
    bones_ = std::move(bones).value();
  }
  motion::Motion pose{*body_, 1, 0, Eigen::VectorXd::Zero(body_->dof)};
  SetPose(*body_, character, pose.q.col(0));
  const auto humanoid = motion::Humanoid(pose);
  if (!humanoid) return {};
  body::Kinematics at(humanoid->skeleton);
  body::ComputeKinematics(humanoid->skeleton, humanoid->q.col(0), at);
  std::vector<std::string> messages = {
      VmcState(kCalibrated),
      Pose("/VMC/Ext/Root/Pos", "root", Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity())};
  for (int i = 0; i < body_->size(); ++i) {
    const auto own = static_cast<std::size_t>(i);
    if (bones_[own].empty()) continue;
    Eigen::Vector3d p = at.p_WJ[own];
    Eigen::Matrix3d R = at.R_WJ[own];
    int parent = body_->joint(i).parent;
    while (parent >= 0 && bones_[static_cast<std::size_t>(parent)].empty()) {
      parent = body_->joint(parent).parent;
    }
    if (parent >= 0) {
      const Eigen::Matrix3d R_PW = at.R_WJ[static_cast<std::size_t>(parent)].transpose();
      p = R_PW * (p - at.p_WJ[static_cast<std::size_t>(parent)]);
      R = R_PW * R;
    }
    messages.push_back(Pose("/VMC/Ext/Bone/Pos", bones_[own], ToUnity(p),
                            ToUnity(Eigen::Quaterniond(R).normalized())));
  }
  messages.push_back(VmcTime(frame.time_s()));
  return Bundles(messages);
}

std::vector<std::string> OscEncoder::EncodePlain(const v1::CharacterFrame& frame) const {
  std::vector<std::string> messages;
  for (const v1::Character& character : frame.characters()) {
    const auto skeleton = skeletons_.find(character.character());
    if (skeleton == skeletons_.end()) continue;
    const std::string about = "/footing/character/" + std::to_string(character.character());
    const auto add = [&](const char* what, std::initializer_list<Argument> arguments) {
      messages.push_back(osc::WriteMessage(
          about + what, std::span<const Argument>(arguments.begin(), arguments.size())));
    };
    add("/frame", {frame.time_s(), character.valid()});
    const v1::Vector3& com = character.com_m();
    add("/com", {Float(com.x()), Float(com.y()), Float(com.z())});
    for (int i = 0; i < std::min(character.links_size(), skeleton->second.links_size()); ++i) {
      messages.push_back(Pose((about + "/link").c_str(), skeleton->second.links(i).name(),
                              PlaceOf(character, i), Eigen::Quaterniond(TurnOf(character, i))));
    }
    for (int i = 0; i < character.contacts_size(); ++i) {
      const v1::Contact& contact = character.contacts(i);
      const std::string name = i < skeleton->second.contact_points_size()
                                   ? skeleton->second.contact_points(i)
                                   : std::to_string(i);
      const v1::Vector3& p = contact.position_m();
      add("/contact", {std::string_view(name), contact.touching(), Float(contact.normal_force_n()),
                       Float(p.x()), Float(p.y()), Float(p.z())});
    }
    if (character.has_gait()) {
      const std::string name = v1::Gait_Name(character.gait().gait());
      add("/gait", {std::string_view(name), Float(character.gait().speed_mps()),
                    Float(character.gait().heading_rad()), Float(character.gait().distance_m())});
    }
  }
  return Bundles(messages);
}

namespace {

namespace asio = boost::asio;
using asio::ip::udp;

class OscSender {
 public:
  explicit OscSender(const OscOptions& options)
      : options_(options), encoder_(options.format), end_(io_, [this] { End(); }) {}

  Result<OscReport> Run() {
    for (const std::string& to : options_.to) {
      if (const auto opened = Open(to); !opened) return opened.error();
    }
    transport::ClientOptions client;
    client.address = options_.from;
    client.client_name = "footing-log";
    client.channels = {"skeletons", "characters"};
    client.max_hz = options_.rate_hz;
    transport::ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) { OnTick(tick); };
    handlers.on_state = [this](transport::LinkState, const std::string& why) {
      if (!why.empty()) std::cerr << options_.from.Text() << ": " << why << std::endl;
      why_ = why;
    };
    client_ = std::make_unique<transport::Client>(io_, client, std::move(handlers));
    client_->Start();
    end_.After(options_.seconds, [this] { End(); });
    io_.run();
    if (report_.frames == 0) {
      return NoDevice("no frame came from " + options_.from.Text() + " (" + why_ +
                      "); start footing-sim, or name it with --connect");
    }
    return report_;
  }

 private:
  Result<void> Open(const std::string& to) {
    const std::size_t colon = to.rfind(':');
    const auto port =
        colon == std::string::npos ? std::nullopt : text::ToCount(to.substr(colon + 1));
    if (!port || *port == 0 || *port > 65'535) {
      return UsageError("--to " + to + ": not HOST:PORT, for example 127.0.0.1:39539");
    }
    boost::system::error_code error;
    const auto found =
        udp::resolver(io_).resolve(to.substr(0, colon), std::to_string(*port), error);
    if (error || found.empty()) {
      return UsageError("--to " + to + ": no such host: " + transport::MessageOf(error));
    }
    auto& socket = sockets_.emplace_back(io_);
    socket.open(found.begin()->endpoint().protocol(), error);
    if (!error) socket.non_blocking(true, error);
    if (!error) socket.connect(found.begin()->endpoint(), error);
    if (error) return Failure("--to " + to + ": cannot send: " + transport::MessageOf(error));
    return {};
  }

  void OnTick(const v1::Tick& tick) {
    if (tick.has_skeletons()) encoder_.Take(tick.skeletons());
    if (!tick.has_characters()) return;
    const std::vector<std::string> packets = encoder_.Encode(tick.characters());
    if (packets.empty()) return;
    const std::int64_t now_ns = clock::MonotonicNs();
    if (report_.frames++ > 0) {
      report_.longest_gap_s =
          std::max(report_.longest_gap_s, NanosecondsToSeconds(now_ns - sent_ns_));
    }
    sent_ns_ = now_ns;
    for (udp::socket& socket : sockets_) {
      for (const std::string& packet : packets) {
        boost::system::error_code error;  // Nobody listens yet, or any more.
        report_.bytes += socket.send(asio::buffer(packet), 0, error);
        report_.refused += error ? 1 : 0;
        ++report_.packets;
      }
    }
  }

  void End() {
    client_->Stop();
    io_.stop();
  }

  const OscOptions& options_;
  asio::io_context io_{1};
  OscEncoder encoder_;
  std::vector<udp::socket> sockets_;
  std::unique_ptr<transport::Client> client_;
  service_manager::ProgramEnd end_;
  std::string why_ = "not connected yet";
  std::int64_t sent_ns_ = 0;
  OscReport report_;
};

}  // namespace

Result<OscReport> SendOsc(const OscOptions& options) { return OscSender(options).Run(); }

}  // namespace footing::log_client
