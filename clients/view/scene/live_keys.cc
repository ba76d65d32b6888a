#include "clients/view/scene/live_keys.h"

#include <algorithm>
#include <array>

namespace footing::scene {
namespace {

/// Whose key it is.
enum class Of { kAll, kBiped, kPerson };

struct LiveKey {
  const char* key;
  const char* what;
  Of of;
};

constexpr std::array<LiveKey, 15> kLiveKeys{{
    {"?", "show or hide this list", Of::kAll},
    {"H", "hide or show the panels", Of::kAll},
    {"F11", "full screen, or a window again", Of::kAll},
    {"mouse", "drag to turn the view, wheel to zoom", Of::kAll},
    {"Z", "the view from behind again; also a double click", Of::kBiped},
    {"Z", "the view from the front again; also a double click", Of::kPerson},
    {"F", "force arrows at the feet", Of::kBiped},
    {"P", "states of the gait controller", Of::kBiped},
    {"R", "replay the last fall in slow motion", Of::kBiped},
    {"T", "take the T-pose again", Of::kPerson},
    {"N", "the next subject", Of::kPerson},
    {"O", "the true pose beside the body, or over it", Of::kPerson},
    {"V", "the preview of the camera", Of::kAll},
    {"C", "calibrate where the camera stands; X ends it", Of::kAll},
    {"space", "freeze the picture", Of::kAll},
}};

bool Is(const LiveKey& key, char letter) { return key.key[0] == letter && key.key[1] == '\0'; }

bool IsOfOther(Of of, Engine engine) {
  return (of == Of::kBiped && engine == Engine::kPerson) ||
         (of == Of::kPerson && engine == Engine::kBiped);
}

/// T and N send a command.
bool Commands(char letter) { return letter == 'T' || letter == 'N'; }

}  // namespace

Engine EngineOf(const Model& model) {
  if (model.playout.empty() || model.playout.Newest().characters.empty()) return Engine::kUnknown;
  return model.playout.Newest().characters.front().body ? Engine::kPerson : Engine::kBiped;
}

KeyContext ContextOf(const Model& model, bool has_subjects, bool calibrates) {
  const bool may_command =
      std::any_of(model.links.begin(), model.links.end(), [](const LinkReport& link) {
        return link.server_id == "footing-sim" && link.state == LinkState::kLive &&
               link.address.rfind("unix:", 0) == 0;
      });
  return {EngineOf(model), has_subjects, calibrates, may_command};
}

std::vector<KeyLine> LiveKeyLines(const KeyContext& context) {
  std::vector<KeyLine> lines;
  for (const LiveKey& key : kLiveKeys) {
    const bool shown = key.of == Of::kAll
                           ? !Is(key, 'C') || context.calibrates
                           : context.engine != Engine::kUnknown &&
                                 !IsOfOther(key.of, context.engine) &&
                                 (!Commands(key.key[0]) || WhyNoKey(key.key[0], context).empty());
    if (shown) lines.push_back({key.key, key.what});
  }
  lines.push_back({"Esc, Q", "quit"});
  return lines;
}

std::string WhyNoKey(char letter, const KeyContext& context) {
  const auto* const key =
      std::find_if(kLiveKeys.begin(), kLiveKeys.end(),
                   [letter](const LiveKey& one) { return one.of != Of::kAll && Is(one, letter); });
  if (key == kLiveKeys.end() || letter == 'Z') return "";
  const std::string does = std::string("Key ") + key->key + " (" + key->what + "): ";
  if (IsOfOther(key->of, context.engine)) {
    return does + (key->of == Of::kPerson
                       ? "only for a person on boards. Start footing-sim with --engine pose."
                       : "only for the biped. Start footing-sim with --engine gait.");
  }
  if (!Commands(letter)) return "";
  if (letter == 'N' && !context.has_subjects)
    return does + "no subject file was named. Start footing-view with --next-subject FILE.";
  if (!context.may_command)
    return does + "works only on the machine where footing-sim runs, while it is connected.";
  return "";
}

}  // namespace footing::scene
