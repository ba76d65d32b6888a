#include <algorithm>

#include "daemon/simulation/engine/parts.h"
#include "daemon/simulation/biped/append.h"
#include "daemon/simulation/biped/endless.h"

namespace footing::engine {
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
  if (const char* why = terrain::WhyNotAppended(on.track, segment, place.segment); why != nullptr) {
    AddEvent({.kind = EventKind::kAppendRefused, .text = why});
    return;
  }
  // The segment that was last may have to reach under the new one.
  const std::uint64_t last = state.track.first_segment + on.track.segments.size() - 1;
  box_holds[static_cast<std::size_t>(last) % static_cast<std::size_t>(on.window.boxes)] = 0;
  const std::size_t before = on.track.segments.size();
  terrain::Append(segment, on.track);
  if (on.track.segments.size() == before) ++state.track.first_segment;
  place = terrain::Locate(on.track, body.p_WB.head<2>());
  output.append.added = true;
}

void GaitEngine::Parts::ExtendEndless() {
  if (!on.track.endless) return;
  const auto next =
      terrain::EndlessSegment(on.track, place, body.p_WB.head<2>(), state.track.course);
  if (!next) return;
  const std::size_t before = on.track.segments.size();
  terrain::Add(*next, on.track);
  if (on.track.segments.size() == before) ++state.track.first_segment;
  place = terrain::Locate(on.track, body.p_WB.head<2>());
  output.append.added = true;
}

void GaitEngine::Parts::PlaceGround() {
  if (on.window.boxes == 0) return;
  const int from = std::max(0, place.segment - on.window.behind);
  const int to = std::min(static_cast<int>(on.track.segments.size()),
                          place.segment - on.window.behind + on.window.boxes);
  for (int i = from; i < to; ++i) {
    const std::uint64_t number = state.track.first_segment + static_cast<std::uint64_t>(i);
    const auto slot =
        static_cast<std::size_t>(number % static_cast<std::uint64_t>(on.window.boxes));
    if (box_holds[slot] == number + 1) continue;
    box_holds[slot] = number + 1;
    const int index = static_cast<int>(slot);
    const auto index_on_track = static_cast<std::size_t>(i);
    const terrain::GroundBox box = on.track.segments[index_on_track].pit
                                       ? terrain::WaitingBox(index)
                                       : terrain::BoxOf(on.track, index_on_track);
    on.world.PlaceBox(index, box.centre_W_m, box.q_WS, box.half_size_m);
  }
}

void GaitEngine::Parts::SaveTrack(TrackMemory& memory) const {
  memory = state.track;
  if (!terrain::Grows(on.track)) return;
  memory.first_m = on.track.first_m;
  memory.revision = on.track.revision;
  memory.count = on.track.segments.size();
  std::copy(on.track.segments.begin(), on.track.segments.end(), memory.segments.begin());
}

void GaitEngine::Parts::RestoreTrack() {
  if (!terrain::Grows(on.track)) return;
  const TrackMemory& memory = state.track;
  if (memory.count == 0) {
    on.track.segments.assign(on.first_segments.begin(), on.first_segments.end());
    on.track.revision = 1;
    on.track.first_m = 0;
  } else {
    on.track.segments.assign(memory.segments.begin(),
                             memory.segments.begin() + static_cast<std::ptrdiff_t>(memory.count));
    on.track.revision = memory.revision;
    on.track.first_m = memory.first_m;
  }
  if (!on.track.extendable) return;
  // Boxes of another course may be left anywhere: all wait, then those that are needed come.
  for (int i = 0; i < on.window.boxes; ++i) {
    const terrain::GroundBox box = terrain::WaitingBox(i);
    on.world.PlaceBox(i, box.centre_W_m, box.q_WS, box.half_size_m);
  }
  box_holds = {};
}

}  // namespace footing::engine
