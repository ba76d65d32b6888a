#include <algorithm>

#include "daemon/simulation/engine/parts.h"

namespace footing::engine {
namespace {

/// Segments behind the character and, with its own, ahead of it that have a box.
constexpr int kBoxesBehind = 8;
constexpr int kBoxesAhead = terrain::kGroundBoxes - kBoxesBehind;

}  // namespace

void GaitEngine::Parts::TakeAppend(const EngineInputs& inputs) {
  std::uint64_t& taken = state.track.append_number;
  if (taken == inputs.append_number) return;
  const auto listed = static_cast<std::uint64_t>(std::clamp(inputs.append_count, 0, kMaxAppends));
  const std::uint64_t oldest = inputs.append_number - std::min(listed, inputs.append_number) + 1;
  if (taken + 1 < oldest || taken > inputs.append_number) {
    taken = std::min(oldest - 1, inputs.append_number);
    AddEvent({.kind = EventKind::kAppendRefused, .text = "segments were lost on the way"});
    return;
  }
  const terrain::NewSegment& segment = inputs.appends[static_cast<std::size_t>(taken + 1 - oldest)];
  ++taken;
  const int here = terrain::Locate(track, body.p_WB.head<2>()).segment;
  if (const char* why = terrain::WhyNotAppended(track, segment, here); why != nullptr) {
    AddEvent({.kind = EventKind::kAppendRefused, .text = why});
    return;
  }
  // The segment that was last may have to reach under the new one.
  const std::uint64_t last = state.track.first_segment + track.segments.size() - 1;
  box_holds[static_cast<std::size_t>(last % terrain::kGroundBoxes)] = 0;
  const std::size_t before = track.segments.size();
  terrain::Append(segment, track);
  if (track.segments.size() == before) ++state.track.first_segment;
  output.appended = true;
}

void GaitEngine::Parts::PlaceGround() {
  if (!track.extendable) return;
  const int here = terrain::Locate(track, body.p_WB.head<2>()).segment;
  const int from = std::max(0, here - kBoxesBehind);
  const int to = std::min(static_cast<int>(track.segments.size()), here + kBoxesAhead);
  for (int i = from; i < to; ++i) {
    const std::uint64_t number = state.track.first_segment + static_cast<std::uint64_t>(i);
    const auto slot = static_cast<std::size_t>(number % terrain::kGroundBoxes);
    if (box_holds[slot] == number + 1) continue;
    box_holds[slot] = number + 1;
    const int index = static_cast<int>(slot);
    const auto place = static_cast<std::size_t>(i);
    const terrain::GroundBox box =
        track.segments[place].pit ? terrain::WaitingBox(index) : terrain::BoxOf(track, place);
    world.PlaceBox(index, box.centre_W_m, box.q_WS, box.half_size_m);
  }
}

void GaitEngine::Parts::SaveTrack(TrackMemory& memory) const {
  memory = state.track;
  if (!track.extendable) return;
  memory.revision = track.revision;
  memory.count = track.segments.size();
  std::copy(track.segments.begin(), track.segments.end(), memory.segments.begin());
}

void GaitEngine::Parts::RestoreTrack() {
  if (!track.extendable) return;
  const TrackMemory& memory = state.track;
  if (memory.count == 0) {
    track.segments.assign(first_segments.begin(), first_segments.end());
    track.revision = 1;
  } else {
    track.segments.assign(memory.segments.begin(),
                          memory.segments.begin() + static_cast<std::ptrdiff_t>(memory.count));
    track.revision = memory.revision;
  }
  // Boxes of another course may be left anywhere: all wait, then those that are needed come.
  for (int i = 0; i < terrain::kGroundBoxes; ++i) {
    const terrain::GroundBox box = terrain::WaitingBox(i);
    world.PlaceBox(i, box.centre_W_m, box.q_WS, box.half_size_m);
  }
  box_holds = {};
}

}  // namespace footing::engine
