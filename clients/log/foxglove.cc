#include "clients/log/foxglove.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>

#include "clients/log/biped_person.h"
#include "clients/log/contents.h"
#include "clients/log/export_xdf.h"
#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/recording/mcap_reader.h"
#include "common/recording/mcap_writer.h"
#include "common/stream/device.h"
#include "common/wire/wire.h"
#include "footing/v1/character.pb.h"
#include "foxglove/messages.pb.h"

namespace footing::log_client {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr char kWorld[] = "world";
constexpr std::int64_t kLeastStepNs = 1'000'000'000 / static_cast<int>(FoxgloveScene::kMostHz);
constexpr double kArrowMPerN = 1e-3;
constexpr double kArrowM = 0.015;  // Its shaft; the head is twice as wide and four times as long.
constexpr double kComM = 0.05;     // Diameters of balls.
constexpr double kCopM = 0.03;
constexpr double kTrackThickM = 0.1;
constexpr double kLimbOfJoint = 0.8;  // A limb's width, in parts of its upper joint's.

struct Colour {
  double r, g, b, a = 1;
};
constexpr Colour kSkin{0.75, 0.62, 0.55}, kBird{0.85, 0.45, 0.25}, kForce{0.10, 0.55, 0.90};
constexpr Colour kPlate{0.92, 0.92, 0.95}, kComColour{0.95, 0.75, 0.10};
constexpr Colour kSlabs[] = {{0.50, 0.60, 0.50}, {0.42, 0.52, 0.44}};

void Set(const Colour& colour, foxglove::Color& to) {
  to.set_r(colour.r);
  to.set_g(colour.g);
  to.set_b(colour.b);
  to.set_a(colour.a);
}

void Set(const Vector3d& value, foxglove::Vector3& to) {
  to.set_x(std::isfinite(value.x()) ? value.x() : 0);
  to.set_y(std::isfinite(value.y()) ? value.y() : 0);
  to.set_z(std::isfinite(value.z()) ? value.z() : 0);
}

void Set(const Eigen::Quaterniond& value, foxglove::Quaternion& to) {
  const double norm = value.norm();
  const bool is_rotation = std::isfinite(norm) && norm > 1e-6;
  const Eigen::Quaterniond q = is_rotation ? value.normalized() : Eigen::Quaterniond::Identity();
  to.set_x(q.x());
  to.set_y(q.y());
  to.set_z(q.z());
  to.set_w(q.w());
}

void Set(const Vector3d& place, const Eigen::Quaterniond& turn, foxglove::Pose& to) {
  Set(place, *to.mutable_position());
  Set(turn, *to.mutable_orientation());
}

void Set(std::int64_t time_ns, google::protobuf::Timestamp& to) {
  to.set_seconds(time_ns / 1'000'000'000);
  to.set_nanos(static_cast<std::int32_t>(time_ns % 1'000'000'000));
}

foxglove::SceneEntity& AddEntity(const std::string& id, const std::string& frame,
                                 const recording::Stamp& stamp, foxglove::SceneUpdate& update) {
  foxglove::SceneEntity& entity = *update.add_entities();
  Set(stamp.log_ns, *entity.mutable_timestamp());
  entity.set_id(id);
  entity.set_frame_id(frame);
  entity.set_frame_locked(true);
  return entity;
}

void AddBall(const Vector3d& place, const Vector3d& size_m, const Colour& colour,
             foxglove::SceneEntity& entity) {
  foxglove::SpherePrimitive& ball = *entity.add_spheres();
  Set(place, Eigen::Quaterniond::Identity(), *ball.mutable_pose());
  Set(size_m, *ball.mutable_size());
  Set(colour, *ball.mutable_color());
}

/// A cylinder between two points of the entity's frame.
void AddLimb(const Vector3d& from, const Vector3d& to, double width_m, const Colour& colour,
             foxglove::SceneEntity& entity) {
  const Vector3d along = to - from;
  if (!along.allFinite() || along.norm() < 1e-3) return;
  foxglove::CylinderPrimitive& limb = *entity.add_cylinders();
  Set((from + to) / 2, Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), along),
      *limb.mutable_pose());
  Set(Vector3d(width_m, width_m, along.norm()), *limb.mutable_size());
  limb.set_bottom_scale(1);
  limb.set_top_scale(1);
  Set(colour, *limb.mutable_color());
}

void AddBox(const Isometry3d& pose, const Vector3d& size_m, const Colour& colour,
            foxglove::SceneEntity& entity) {
  foxglove::CubePrimitive& box = *entity.add_cubes();
  Set(pose.translation(), Eigen::Quaterniond(pose.linear()), *box.mutable_pose());
  Set(size_m, *box.mutable_size());
  Set(colour, *box.mutable_color());
}

/// A force straight up from where it acts. One of less than a newton is not drawn.
void AddForce(const Vector3d& place, double force_n, foxglove::SceneEntity& entity) {
  if (!std::isfinite(force_n) || !(force_n > 1)) return;
  const Eigen::Quaterniond up(Eigen::AngleAxisd(-M_PI / 2, Vector3d::UnitY()));
  foxglove::ArrowPrimitive& arrow = *entity.add_arrows();
  Set(place, up, *arrow.mutable_pose());
  const double length_m = force_n * kArrowMPerN, head_m = std::min(4 * kArrowM, length_m / 2);
  arrow.set_shaft_length(length_m - head_m);
  arrow.set_shaft_diameter(kArrowM);
  arrow.set_head_length(head_m);
  arrow.set_head_diameter(2 * kArrowM);
  Set(kForce, *arrow.mutable_color());
}

void AddTransform(const std::string& child, const Vector3d& place, const Eigen::Quaterniond& turn,
                  const recording::Stamp& stamp, foxglove::FrameTransforms& transforms) {
  foxglove::FrameTransform& transform = *transforms.add_transforms();
  Set(stamp.log_ns, *transform.mutable_timestamp());
  transform.set_parent_frame_id(kWorld);
  transform.set_child_frame_id(child);
  Set(place, *transform.mutable_translation());
  Set(turn, *transform.mutable_rotation());
}

/// One name for one link, whatever names the motion file had.
std::string LinkFrame(const std::string& server, const v1::Skeleton& skeleton, int link) {
  const std::string& name = skeleton.links(link).name();
  int same = 0;
  for (int i = 0; i < link; ++i) same += skeleton.links(i).name() == name ? 1 : 0;
  return server + "/" + std::to_string(skeleton.character()) + "/" + name +
         (same > 0 ? "_" + std::to_string(same + 1) : "");
}

/// The shape of a link of an engine's own character, within the extents that it suggests.
void AddShape(const Vector3d& size_m, foxglove::SceneEntity& entity) {
  const bool is_rod = size_m.x() == size_m.y() && size_m.z() > size_m.x();
  if (!is_rod) return AddBall(Vector3d::Zero(), size_m, kBird, entity);
  AddLimb({0, 0, -size_m.z() / 2}, {0, 0, size_m.z() / 2}, size_m.x(), kBird, entity);
}

/// An entity for each link, in its frame. A person has a ball at each joint and a limb to each
/// joint that hangs on it, as long as in this frame.
void AddBody(const std::string& server, const v1::Skeleton& skeleton,
             const v1::Character& character, const recording::Stamp& stamp,
             foxglove::SceneUpdate& update) {
  const bool is_person = skeleton.name() == "person";
  for (int i = 0; i < skeleton.links_size(); ++i) {
    const std::string frame = LinkFrame(server, skeleton, i);
    foxglove::SceneEntity& entity = AddEntity(frame, frame, stamp, update);
    const Vector3d size_m = wire::FromProto(skeleton.links(i).size_m());
    if (!is_person) {
      AddShape(size_m, entity);
      continue;
    }
    AddBall(Vector3d::Zero(), size_m, kSkin, entity);
    for (int child = i + 1; child < skeleton.links_size(); ++child) {
      if (skeleton.links(child).parent() != i) continue;
      const Vector3d reach_L =
          TurnOf(character, i).transpose() * (PlaceOf(character, child) - PlaceOf(character, i));
      AddLimb(Vector3d::Zero(), reach_L, kLimbOfJoint * size_m.x(), kSkin, entity);
    }
  }
}

foxglove::SceneUpdate Drawn(const v1::Track& track, const std::string& server,
                            const recording::Stamp& stamp) {
  foxglove::SceneUpdate update;
  foxglove::SceneEntity& entity = AddEntity(server + "/track", kWorld, stamp, update);
  for (int i = 0; i < track.segments_size(); ++i) {
    const v1::TrackSegment& segment = track.segments(i);
    if (segment.pit()) continue;
    Isometry3d pose = Isometry3d::Identity();
    pose.translate(wire::FromProto(segment.start_m()));
    pose.rotate(Eigen::AngleAxisd(segment.heading_rad(), Vector3d::UnitZ()));
    pose.rotate(Eigen::AngleAxisd(-segment.slope_rad(), Vector3d::UnitY()));
    pose.translate(Vector3d(segment.length_m() / 2, 0, -kTrackThickM / 2));
    AddBox(pose, {segment.length_m(), segment.width_m(), kTrackThickM}, kSlabs[i % 2], entity);
  }
  return update;
}

foxglove::PointCloud Joints(const v1::Character& character, const recording::Stamp& stamp) {
  foxglove::PointCloud cloud;
  Set(stamp.log_ns, *cloud.mutable_timestamp());
  cloud.set_frame_id(kWorld);
  Set(Vector3d::Zero(), Eigen::Quaterniond::Identity(), *cloud.mutable_pose());
  cloud.set_point_stride(3 * sizeof(float));
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    foxglove::PackedElementField& field = *cloud.add_fields();
    field.set_name(std::string(1, static_cast<char>('x' + axis)));
    field.set_offset(axis * sizeof(float));
    field.set_type(foxglove::PackedElementField::FLOAT32);
  }
  for (int i = 0; i < character.links_size(); ++i) {
    const Eigen::Vector3f p = PlaceOf(character, i).cast<float>();
    cloud.mutable_data()->append(reinterpret_cast<const char*>(p.data()), 3 * sizeof(float));
  }
  return cloud;
}

bool IsTrouble(v1::Event::Kind kind) {
  return kind == v1::Event::KIND_FALL || kind == v1::Event::KIND_STREAM_LOST;
}

}  // namespace

bool FoxgloveScene::IsDue(const Server& server, const char* topic, std::int64_t now_ns) {
  const auto newest = server.newest_ns.find(topic);
  return newest == server.newest_ns.end() || now_ns - newest->second >= kLeastStepNs;
}

Result<void> FoxgloveScene::Send(const char* topic, const google::protobuf::Message& message,
                                 const recording::Stamp& stamp, Server& server) {
  const auto newest = server.newest_ns.find(topic);
  if (newest != server.newest_ns.end() && stamp.log_ns <= newest->second) return {};
  server.newest_ns[topic] = stamp.log_ns;
  return write_(kFoxgloveTopics + server.name + "/" + topic, message, stamp);
}

void FoxgloveScene::Learn(const v1::Tick& tick, Server& server) {
  if (tick.has_skeletons()) {
    const auto& skeletons = tick.skeletons().skeletons();
    server.skeletons.assign(skeletons.begin(), skeletons.end());
    server.draw_bodies = true;
  }
  if (tick.has_track()) {
    server.track = tick.track();
    server.draw_track = true;
  }
  for (const v1::RigSetup& rig : tick.setup().rigs()) {
    server.layouts[rig.rig()] = rig.layout();
    server.draw_boards = true;
  }
  for (const v1::DeviceStatus& status : tick.status().devices()) {
    const bool is_board =
        status.role() == v1::DEVICE_ROLE_LEFT_BOARD || status.role() == v1::DEVICE_ROLE_RIGHT_BOARD;
    if (!is_board) continue;
    v1::DeviceStatus& known = server.boards[status.device()];
    server.draw_boards |= known.role() != status.role() || known.rig() != status.rig();
    known = status;
  }
  for (const v1::BoardSample& sample : tick.boards().samples()) {
    server.loads[sample.device()] = sample;
  }
}

Result<void> FoxgloveScene::OnTick(const std::string& name, const v1::Tick& tick,
                                   const recording::Stamp& stamp) {
  Server& server = servers_[name];
  server.name = name;
  Learn(tick, server);
  if (tick.has_characters()) {
    if (auto sent = Characters(tick.characters(), stamp, server); !sent) return sent;
  }
  if (tick.has_boards()) {
    if (auto sent = Boards(stamp, server); !sent) return sent;
  }
  return Log(tick.events(), stamp, server);
}

Result<void> FoxgloveScene::Characters(const v1::CharacterFrame& frame,
                                       const recording::Stamp& stamp, Server& server) {
  if (!IsDue(server, "transforms", stamp.log_ns)) return {};
  foxglove::FrameTransforms transforms;
  foxglove::SceneUpdate bodies, forces;
  foxglove::PointCloud joints;
  for (const v1::Character& character : frame.characters()) {
    const auto skeleton =
        std::find_if(server.skeletons.begin(), server.skeletons.end(), [&](const auto& one) {
          return one.character() == character.character() &&
                 one.links_size() == character.links_size();
        });
    if (skeleton == server.skeletons.end() || character.links_size() == 0) continue;
    for (int i = 0; i < character.links_size(); ++i) {
      AddTransform(LinkFrame(server.name, *skeleton, i), PlaceOf(character, i),
                   wire::FromProto(character.links(i).orientation()), stamp, transforms);
    }
    if (server.draw_bodies) AddBody(server.name, *skeleton, character, stamp, bodies);
    const std::string id = server.name + "/" + std::to_string(character.character());
    foxglove::SceneEntity& entity = AddEntity(id + "/forces", kWorld, stamp, forces);
    AddBall(wire::FromProto(character.com_m()), Vector3d::Constant(kComM), kComColour, entity);
    for (const v1::Contact& contact : character.contacts()) {
      if (!contact.touching()) continue;
      AddForce(wire::FromProto(contact.position_m()), contact.normal_force_n(), entity);
    }
    joints = Joints(character, stamp);
  }
  if (transforms.transforms_size() == 0) return {};
  if (auto sent = Send("transforms", transforms, stamp, server); !sent) return sent;
  if (std::exchange(server.draw_bodies, false)) {
    if (auto sent = Send("body", bodies, stamp, server); !sent) return sent;
  }
  if (std::exchange(server.draw_track, false)) {
    const auto track = Drawn(server.track, server.name, stamp);
    if (auto sent = Send("track", track, stamp, server); !sent) return sent;
  }
  if (auto sent = Send("forces", forces, stamp, server); !sent) return sent;
  return Send("joints", joints, stamp, server);
}

Result<void> FoxgloveScene::Boards(const recording::Stamp& stamp, Server& server) {
  if (!IsDue(server, "boards", stamp.log_ns)) return {};
  foxglove::FrameTransforms transforms;
  foxglove::SceneUpdate update;
  for (const auto& [device, status] : server.boards) {
    const auto load = server.loads.find(device);
    if (load == server.loads.end()) continue;
    const bool left = status.role() == v1::DEVICE_ROLE_LEFT_BOARD;
    const std::string frame = server.name + "/" + status.rig() + "/" +
                              stream::Name(static_cast<stream::DeviceRole>(status.role()));
    const stream::BoardLayout layout =
        board::LayoutOr(wire::FromProto(server.layouts[status.rig()]));
    const stream::BoardPose& pose = left ? layout.left : layout.right;
    // P's x is to the plate's right: with yaw 0 the front points along W's x.
    AddTransform(frame, {pose.x_m, pose.y_m, 0},
                 Eigen::Quaterniond(Eigen::AngleAxisd(pose.yaw_rad - M_PI / 2, Vector3d::UnitZ())),
                 stamp, transforms);
    foxglove::SceneEntity& entity = AddEntity(frame, frame, stamp, update);
    const auto geometry = board::GeometryOr(left ? layout.left_geometry : layout.right_geometry);
    Isometry3d plate = Isometry3d::Identity();
    plate.translation().z() = -board::kPlateHeightM / 2;
    AddBox(plate, {geometry.plate_x_m, geometry.plate_y_m, board::kPlateHeightM}, kPlate, entity);
    if (!load->second.cop_valid()) continue;
    const Vector3d cop_P(load->second.cop_x_m(), load->second.cop_y_m(), 0);
    AddBall(cop_P, Vector3d::Constant(kCopM), kForce, entity);
    AddForce(cop_P, load->second.total_n(), entity);
  }
  if (update.entities_size() == 0) return {};
  if (std::exchange(server.draw_boards, false)) {
    if (auto sent = Send("transforms", transforms, stamp, server); !sent) return sent;
  }
  return Send("boards", update, stamp, server);
}

Result<void> FoxgloveScene::Log(const v1::Events& events, recording::Stamp stamp, Server& server) {
  for (const v1::Event& event : events.events()) {
    foxglove::Log log;
    Set(event.host_ns() > 0 ? event.host_ns() : stamp.log_ns, *log.mutable_timestamp());
    log.set_level(IsTrouble(event.kind()) ? foxglove::Log::WARNING : foxglove::Log::INFO);
    log.set_message(EventText(event));
    log.set_name(server.name);
    const auto newest = server.newest_ns.find("log");
    if (newest != server.newest_ns.end()) {
      stamp.log_ns = std::max(stamp.log_ns, newest->second + 1);
    }
    if (auto sent = Send("log", log, stamp, server); !sent) return sent;
  }
  return {};
}

namespace {

/// Copies a recording message by message and adds Foxglove's behind those that they are made of.
class FoxgloveCopier {
 public:
  FoxgloveCopier(recording::OutputFile& file, const std::string& library, std::string path)
      : file_(file),
        path_(std::move(path)),
        writer_({"", library}, {}),
        scene_([this](const auto& topic, const auto& message, const auto& stamp) {
          return Add(topic, message, stamp);
        }) {}

  /// The first pass: ids of our topics are above those of the recording.
  mcap::Visitor Learner() {
    mcap::Visitor visitor;
    visitor.schema = [this](const mcap::Schema& schema) {
      if (!schema.name.starts_with("foxglove.")) writer_.CopySchema(schema);
    };
    visitor.channel = [this](const mcap::Channel& channel) {
      if (channel.topic.starts_with(kFoxgloveTopics)) {
        dropped_.insert(channel.id);
        return;
      }
      writer_.CopyChannel(channel);
      const std::size_t slash = channel.topic.rfind('/');
      if (slash == std::string::npos || slash == 0) return;
      const auto* field = v1::Tick::descriptor()->FindFieldByName(channel.topic.substr(slash + 1));
      if (field == nullptr || field->message_type() == nullptr) return;
      sources_[channel.id] = {channel.topic.substr(1, slash - 1), field};
    };
    return visitor;
  }

  mcap::Visitor Copier() {
    mcap::Visitor visitor;
    visitor.message = [this](const mcap::Message& message) { Copy(message); };
    visitor.attachment = [this](const mcap::Attachment& attachment) { writer_.Add(attachment); };
    visitor.metadata = [this](const mcap::Metadata& metadata) { writer_.Add(metadata); };
    visitor.chunk = [this](const mcap::Chunk& chunk) {
      writer_.SetCompress(chunk.compression == mcap::kZstd);
    };
    return visitor;
  }

  Result<std::vector<FoxgloveTopic>> Finish() {
    writer_.Finish();
    WriteDown();
    if (!done_) return done_.error();
    if (const auto synced = file_.Sync(); !synced) return synced.error();
    std::vector<FoxgloveTopic> topics;
    for (const auto& [name, added] : added_) topics.push_back(added.topic);
    return topics;
  }

 private:
  /// Where a topic's messages belong in a tick.
  struct Source {
    std::string server;
    const google::protobuf::FieldDescriptor* field = nullptr;
  };
  struct Added {
    std::uint16_t channel = 0;
    FoxgloveTopic topic;
  };

  void Copy(const mcap::Message& message) {
    if (dropped_.contains(message.channel_id)) return;
    writer_.Add(message);
    const auto source = sources_.find(message.channel_id);
    if (done_ && source != sources_.end()) {
      v1::Tick tick;
      google::protobuf::Message* part =
          tick.GetReflection()->MutableMessage(&tick, source->second.field);
      const recording::Stamp stamp{static_cast<std::int64_t>(message.log_time_ns),
                                   static_cast<std::int64_t>(message.publish_time_ns),
                                   message.sequence};
      if (part->ParseFromArray(message.data.data(), static_cast<int>(message.data.size()))) {
        done_ = scene_.OnTick(source->second.server, tick, stamp);
      } else {
        done_ = InvalidData(path_ + ": a message on /" + source->second.server + "/" +
                            source->second.field->name() + " cannot be read");
      }
    }
    WriteDown();
  }

  Result<void> Add(const std::string& topic, const google::protobuf::Message& message,
                   const recording::Stamp& stamp) {
    Added& added = added_[topic];
    if (added.channel == 0) {
      const std::string& type = message.GetDescriptor()->full_name();
      auto& schema = schemas_[type];
      if (schema == 0) {
        schema = writer_.AddSchema(type, "protobuf",
                                   recording::DescribeWithImports(*message.GetDescriptor()));
      }
      added.channel = writer_.AddChannel(schema, topic, "protobuf", {});
      added.topic = {topic, type, 0};
    }
    ++added.topic.messages;
    const std::string bytes = message.SerializeAsString();
    mcap::Message record;
    record.channel_id = added.channel;
    record.sequence = stamp.sequence;
    record.log_time_ns = static_cast<std::uint64_t>(stamp.log_ns);
    record.publish_time_ns = static_cast<std::uint64_t>(stamp.publish_ns);
    record.data = bytes;
    writer_.Add(record);
    return {};
  }

  void WriteDown() {
    const std::string bytes = writer_.Take();
    if (done_ && !bytes.empty()) done_ = file_.Write(bytes);
  }

  recording::OutputFile& file_;
  const std::string path_;  ///< Path of the recording, for errors.
  mcap::Writer writer_;
  FoxgloveScene scene_;
  std::set<std::uint16_t> dropped_;  ///< Channels of an earlier export.
  std::map<std::uint16_t, Source> sources_;
  std::map<std::string, std::uint16_t> schemas_;
  std::map<std::string, Added> added_;
  Result<void> done_;
};

}  // namespace

Result<ExportedFoxglove> ExportFoxglove(const std::string& recording, const std::string& folder,
                                        const std::string& library, bool replace) {
  const auto in = recording::OpenRecording(recording);
  if (!in) return in.error();
  const std::string path =
      folder + "/" + std::filesystem::path(recording).stem().string() + "_foxglove.mcap";
  if (const Result<void> made = MakeFolder(folder); !made) return made.error();
  auto out = recording::OutputFile::Create(path, replace);
  if (!out) return out.error();
  FoxgloveCopier copier(*out, library, recording);
  const auto learned = mcap::Walk(in->bytes(), copier.Learner(), mcap::WalkMode::kStrict);
  if (const auto incomplete = Incomplete(recording, learned)) return *incomplete;
  mcap::Walk(in->bytes(), copier.Copier(), mcap::WalkMode::kStrict);
  auto topics = copier.Finish();
  if (topics && topics->empty()) {
    topics = InvalidData(recording + " has no character, board or event that can be drawn");
  }
  if (topics) return ExportedFoxglove{path, *std::move(topics)};
  std::filesystem::remove(path);
  return topics.error();
}

}  // namespace footing::log_client
