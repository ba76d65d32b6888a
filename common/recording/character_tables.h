#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "common/recording/run_clock.h"
#include "common/recording/tables.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/session.pb.h"

namespace footing::bids {

/// The frames of footing-sim: "sim" for a character of the gaits, "body" for a reconstructed person
/// from the T-pose on. Of several characters the first.
class CharacterTables {
 public:
  void Add(double time_s, const v1::Tick& tick);
  /// Those with a row, without their contents: once.
  std::vector<MotionTable> Take();

 private:
  void AddBody(double time_s, const v1::Character& character);

  v1::Skeleton skeleton_;
  MotionTable sim_, body_;
};

/// Appends what a data set needs of a tick's events; `undone` has the failures that do not count.
void AddEvents(const v1::Tick& tick, const RunClock& clock, const std::set<std::uint64_t>& undone,
               std::vector<Event>& events);

}  // namespace footing::bids
