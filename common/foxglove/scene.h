#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <google/protobuf/message.h>

#include "common/base/result.h"
#include "common/recording/recording_writer.h"
#include "footing/v1/session.pb.h"

namespace footing::foxglove_scene {

/// Topics of Foxglove's messages begin so; then follow the server and "transforms", "body", ...
/// Exports of a recording pass over them: they repeat what the servers' own channels have.
inline constexpr char kTopics[] = "/foxglove/";

/// The channels of servers as messages that Foxglove and Lichtblick draw without a plug-in:
///
///   transforms  FrameTransforms of every link and board; the root frame is "world" (W)
///   body        SceneUpdate, once a skeleton: the links' shapes, which move with their frames
///   forces      SceneUpdate: an arrow at each contact and the COM, 1 mm a newton
///   track       SceneUpdate, with each change of the track
///   boards      SceneUpdate: plates, centres of pressure with the load as an arrow
///   joints      PointCloud of a character's links, for Rerun
///   log         Log: events and markers
///
/// Moving things have at most kMostHz messages a second. Times of a topic rise strictly: a frame
/// that is not later than the one before is dropped, an event is dated 1 ns after the one before.
/// Numbers that are not finite are 0, rotations then none.
class Scene {
 public:
  static constexpr double kMostHz = 35;

  using Write =
      std::function<Result<void>(const std::string& topic, const google::protobuf::Message& message,
                                 const recording::Stamp& stamp)>;
  explicit Scene(Write write) : write_(std::move(write)) {}

  /// Ticks of each server in order; `server` is the name of its topics. Returns what `write` said.
  Result<void> OnTick(const std::string& server, const v1::Tick& tick,
                      const recording::Stamp& stamp);

 private:
  /// State of one server, and what is to be drawn again with the next frame.
  struct Server {
    std::string name;
    std::vector<v1::Skeleton> skeletons;
    v1::Track track;
    std::map<std::uint32_t, v1::DeviceStatus> boards;  ///< By device.
    std::map<std::string, v1::BoardLayout> layouts;    ///< By rig.
    std::map<std::uint32_t, v1::BoardSample> loads;    ///< The newest of each board.
    std::map<std::string, std::int64_t> newest_ns;     ///< By topic.
    bool draw_bodies = false, draw_track = false, draw_boards = false;
  };

  void Learn(const v1::Tick& tick, Server& server);
  Result<void> Characters(const v1::CharacterFrame& frame, const recording::Stamp& stamp,
                          Server& server);
  Result<void> Boards(const recording::Stamp& stamp, Server& server);
  Result<void> Log(const v1::Events& events, recording::Stamp stamp, Server& server);
  /// Whether the topic's next message is due.
  static bool IsDue(const Server& server, const char* topic, std::int64_t now_ns);
  Result<void> Send(const char* topic, const google::protobuf::Message& message,
                    const recording::Stamp& stamp, Server& server);

  Write write_;
  std::map<std::string, Server> servers_;
};

}  // namespace footing::foxglove_scene
