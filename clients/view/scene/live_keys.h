#pragma once

#include <string>
#include <vector>

#include "clients/view/scene/model.h"

namespace footing::scene {

/// What the connected footing-sim runs: the biped, a person on boards, or nothing that has come
/// yet.
enum class Engine { kUnknown, kBiped, kPerson };
Engine EngineOf(const Model& model);

/// What decides which keys of a live view do something.
struct KeyContext {
  Engine engine = Engine::kUnknown;
  bool has_subjects = false;  ///< Files for the key N were named.
  bool calibrates = false;    ///< A camera file for the key C was named.
  bool may_command = false;   ///< footing-sim is connected, on this machine.
};
KeyContext ContextOf(const Model& model, bool has_subjects, bool calibrates);

/// A line of the list of keys.
struct KeyLine {
  std::string key;
  std::string what;
};

/// The keys of a live view that do something now, in the order of the list.
std::vector<KeyLine> LiveKeyLines(const KeyContext& context);

/// Why a key does nothing now, and what to do; empty where it does what the list says. `key` is a
/// capital letter.
std::string WhyNoKey(char key, const KeyContext& context);

}  // namespace footing::scene
