#include "clients/view/scene/model.h"

#include <algorithm>

namespace footing::scene {
namespace {

constexpr std::size_t kMaxBoards = 8;
constexpr std::size_t kMaxTracePoints = 1500;
constexpr std::size_t kMaxSpans = 512;
constexpr std::size_t kMaxPhases = 8;
constexpr std::int64_t kReferencesNs = 500'000'000;
constexpr double kStandingN = 50;  // Five kilograms: less is not a person.

void Replace(std::vector<Device>& devices, int source,
             const std::vector<stream::DeviceStatus>& statuses) {
  std::erase_if(devices, [source](const Device& device) { return device.source == source; });
  for (const stream::DeviceStatus& status : statuses) devices.push_back({source, status});
}

/// A device that its server does not list any more, such as after a restart, or that is lost while
/// another one has its place.
bool IsGone(std::uint32_t device, const std::vector<stream::DeviceStatus>& statuses) {
  const auto own =
      std::find_if(statuses.begin(), statuses.end(),
                   [device](const stream::DeviceStatus& one) { return one.device == device; });
  if (own == statuses.end()) return true;
  if (own->state != stream::DeviceState::kLost) return false;
  if (own->role == stream::DeviceRole::kUnspecified) return false;
  return std::any_of(statuses.begin(), statuses.end(), [own](const stream::DeviceStatus& other) {
    return other.state != stream::DeviceState::kLost && other.rig == own->rig &&
           other.role == own->role;
  });
}

/// Curves of what is gone would stand beside those of what came in its place.
void DropGone(Model& model, int source, const std::vector<stream::DeviceStatus>& statuses) {
  const auto gone = [&](const auto& one) {
    return one.first.first == source && IsGone(one.first.second, statuses);
  };
  std::erase_if(model.strips.devices, gone);
  std::erase_if(model.boards, gone);
}

void AddBoard(Model& model, int source, std::int64_t received_ns,
              const stream::BoardSample& sample) {
  const std::pair key(source, sample.device);
  if (model.boards.count(key) == 0 && model.boards.size() >= kMaxBoards) return;
  BoardTrace& board = model.boards[key];
  const bool joined = board.newest.cop_valid;
  board.newest = sample;
  board.newest_ns = received_ns;
  if (sample.cop_valid) {
    board.points.push_back({received_ns, static_cast<float>(sample.cop_x_m),
                            static_cast<float>(sample.cop_y_m), joined});
  }
  while (board.points.size() > kMaxTracePoints ||
         (!board.points.empty() && board.points.front().time_ns < received_ns - kStripNs)) {
    board.points.pop_front();
  }
}

void AddNote(Model& model, const Note& note, int source, std::int64_t received_ns) {
  if (note.kind == NoteKind::kResponse) {
    model.last.response = note;
    model.tally.Add(note.response);
    return;
  }
  if (note.text.empty()) return;
  model.last.note = note;
  model.last.note->received_ns = received_ns;
  if (note.kind == NoteKind::kServer) model.last.server[source] = *model.last.note;
}

void AddPhase(Model& model, const CharacterPose& pose, std::int64_t received_ns) {
  std::deque<PhaseSpan>& spans = model.phase_spans;
  const bool same_gait = !spans.empty() && spans.back().gait == pose.gait.gait;
  if (!same_gait) model.phases.clear();
  if (same_gait && spans.back().phase == pose.phase) return;
  spans.push_back({pose.phase, pose.gait.gait, received_ns});
  while (spans.size() > kMaxSpans ||
         (spans.size() > 1 && spans[1].start_ns < received_ns - kStripNs)) {
    spans.pop_front();
  }
  const bool known =
      std::find(model.phases.begin(), model.phases.end(), pose.phase) != model.phases.end();
  if (!known && model.phases.size() < kMaxPhases) model.phases.push_back(pose.phase);
}

void AddReference(Model& model, const ReferencePose& reference) {
  model.observed.references.push_back(reference);
  while (model.observed.references.size() > 1 &&
         model.observed.references.front().received_ns < reference.received_ns - kReferencesNs) {
    model.observed.references.pop_front();
  }
}

stream::DeviceRole RoleOf(const Model& model, const std::pair<int, std::uint32_t>& key) {
  for (const Device& device : model.devices) {
    if (device.source == key.first && device.status.device == key.second) {
      return device.status.role;
    }
  }
  return stream::DeviceRole::kUnspecified;
}

}  // namespace

void Apply(Model& model, const Update& update) {
  if (update.host_ns != 0) {
    std::int64_t& newest_ns = model.newest_host_ns[update.source];
    newest_ns = std::max(newest_ns, update.host_ns);
  }
  if (update.devices) {
    Replace(model.devices, update.source, *update.devices);
    DropGone(model, update.source, *update.devices);
  }
  if (update.skeletons) {
    model.skeletons = *update.skeletons;
    model.anatomy = model.skeletons.empty() ? Anatomy{} : FindAnatomy(model.skeletons.front());
  }
  if (update.track) {
    model.track = *update.track;
    ++model.track_version;
  }
  if (update.game) model.game = *update.game;
  if (update.study) {
    model.study = {*update.study, update.received_ns};
  }
  if (update.setup) model.setup = *update.setup;
  if (update.reference) AddReference(model, *update.reference);
  for (const stream::HandSample& sample : update.hands)
    TakeHand(sample, update.received_ns, model.observed.hands);
  model.strips.Add(update);
  for (const stream::BoardSample& sample : update.boards) {
    AddBoard(model, update.source, update.received_ns, sample);
  }
  for (const Note& note : update.notes) AddNote(model, note, update.source, update.received_ns);
  if (update.frame) {
    if (!update.frame->characters.empty() && !update.frame->characters.front().body) {
      AddPhase(model, update.frame->characters.front(), update.received_ns);
    }
    if (!update.frame->characters.empty()) {
      model.pose_tally.Add(update.frame->characters.front(), model.anatomy, update.host_ns,
                           model.observed.references);
    }
    model.tally.Add(*update.frame);
    model.replay.Push(*update.frame);
    model.playout.Push(*update.frame, update.received_ns);
  }
}

bool IsCurrent(const Model& model, const Device& device) {
  const auto source = static_cast<std::size_t>(device.source);
  // A recording has no connections.
  return source >= model.links.size() || model.links[source].state == LinkState::kLive;
}

bool IsSimulated(const Model& model) {
  const bool device = std::any_of(model.devices.begin(), model.devices.end(),
                                  [](const Device& d) { return d.status.simulated; });
  if (device || model.playout.empty()) return device;
  const auto& characters = model.playout.Newest().characters;
  return std::any_of(characters.begin(), characters.end(),
                     [](const CharacterPose& pose) { return pose.simulated_input; });
}

double AgeMs(const Model& model, std::int64_t now_ns) {
  std::int64_t oldest_ns = IsWaiting(model) ? 0 : now_ns;
  for (const auto& [source, newest_ns] : model.newest_host_ns) {
    oldest_ns = std::min(oldest_ns, newest_ns);
  }
  return std::max(0.0, static_cast<double>(now_ns - oldest_ns) * 1e-6);
}

bool HasPicture(const Model& model) { return !model.playout.empty(); }

bool IsWaiting(const Model& model) { return model.newest_host_ns.empty(); }

const ReferencePose* ReferenceAt(const Model& model, std::int64_t time_ns) {
  if (model.observed.references.empty()) return nullptr;
  const ReferencePose* found = &model.observed.references.front();
  for (const ReferencePose& reference : model.observed.references) {
    if (reference.received_ns <= time_ns) found = &reference;
  }
  return found;
}

Stance StanceOf(const Model& model) {
  Stance stance;
  double left_n = 0, right_n = 0;
  for (const auto& [key, board] : model.boards) {
    const stream::BoardSample& sample = board.newest;
    const double left_cells_n = sample.top_left_n + sample.bottom_left_n;
    const double right_cells_n = sample.top_right_n + sample.bottom_right_n;
    switch (RoleOf(model, key)) {
      case stream::DeviceRole::kLeftBoard:
        left_n += sample.total_n;
        break;
      case stream::DeviceRole::kRightBoard:
        right_n += sample.total_n;
        break;
      case stream::DeviceRole::kUnspecified:
      case stream::DeviceRole::kLeftHand:
      case stream::DeviceRole::kRightHand:
      case stream::DeviceRole::kLeftLeg:
      case stream::DeviceRole::kRightLeg:
      case stream::DeviceRole::kHead:
      case stream::DeviceRole::kTrunk:
      case stream::DeviceRole::kLeftUpperArm:
      case stream::DeviceRole::kRightUpperArm:
      case stream::DeviceRole::kLeftForearm:
      case stream::DeviceRole::kRightForearm:
      case stream::DeviceRole::kEditor:
        left_n += left_cells_n;
        right_n += right_cells_n;
    }
  }
  // A lone board carries both feet, whatever its role is called.
  if (model.boards.size() == 1) {
    const stream::BoardSample& only = model.boards.begin()->second.newest;
    left_n = only.top_left_n + only.bottom_left_n;
    right_n = only.top_right_n + only.bottom_right_n;
  }
  stance.total_n = left_n + right_n;
  stance.valid = stance.total_n > kStandingN;
  if (stance.valid) stance.left_share = std::clamp(left_n / stance.total_n, 0.0, 1.0);
  return stance;
}

}  // namespace footing::scene
