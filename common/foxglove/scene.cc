#include "common/foxglove/scene.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>

#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/recording/event_text.h"
#include "common/stream/device.h"
#include "common/wire/wire.h"
#include "footing/v1/character.pb.h"
#include "foxglove/messages.pb.h"

namespace footing::foxglove_scene {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr char kWorld[] = "world";
constexpr std::int64_t kLeastStepNs = 1'000'000'000 / static_cast<int>(Scene::kMostHz);
constexpr double kArrowMPerN = 1e-3;
constexpr double kArrowM = 0.015;  // Its shaft; the head is twice as wide and four times as long.
constexpr double kComM = 0.05;     // Diameters of balls.
constexpr double kCopM = 0.03;
constexpr double kTrackThickM = 0.1;
constexpr double kLimbOfJoint = 0.8;  // A limb's width, in parts of its upper joint's.

Vector3d PlaceOf(const v1::Character& character, int link) {
  return wire::FromProto(character.links(link).position_m());
}

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
          wire::FromProto(character.links(i).orientation()).normalized().conjugate() *
          (PlaceOf(character, child) - PlaceOf(character, i));
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

bool Scene::IsDue(const Server& server, const char* topic, std::int64_t now_ns) {
  const auto newest = server.newest_ns.find(topic);
  return newest == server.newest_ns.end() || now_ns - newest->second >= kLeastStepNs;
}

Result<void> Scene::Send(const char* topic, const google::protobuf::Message& message,
                         const recording::Stamp& stamp, Server& server) {
  const auto newest = server.newest_ns.find(topic);
  if (newest != server.newest_ns.end() && stamp.log_ns <= newest->second) return {};
  server.newest_ns[topic] = stamp.log_ns;
  return write_(kTopics + server.name + "/" + topic, message, stamp);
}

void Scene::Learn(const v1::Tick& tick, Server& server) {
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

Result<void> Scene::OnTick(const std::string& name, const v1::Tick& tick,
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

Result<void> Scene::Characters(const v1::CharacterFrame& frame, const recording::Stamp& stamp,
                               Server& server) {
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

Result<void> Scene::Boards(const recording::Stamp& stamp, Server& server) {
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

Result<void> Scene::Log(const v1::Events& events, recording::Stamp stamp, Server& server) {
  for (const v1::Event& event : events.events()) {
    foxglove::Log log;
    Set(event.host_ns() > 0 ? event.host_ns() : stamp.log_ns, *log.mutable_timestamp());
    log.set_level(IsTrouble(event.kind()) ? foxglove::Log::WARNING : foxglove::Log::INFO);
    log.set_message(recording::EventText(event));
    log.set_name(server.name);
    const auto newest = server.newest_ns.find("log");
    if (newest != server.newest_ns.end()) {
      stamp.log_ns = std::max(stamp.log_ns, newest->second + 1);
    }
    if (auto sent = Send("log", log, stamp, server); !sent) return sent;
  }
  return {};
}

}  // namespace footing::foxglove_scene
