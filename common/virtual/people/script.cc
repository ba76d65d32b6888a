#include "common/virtual/people/script.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::choreography {
namespace {

using nlohmann::json;

constexpr std::size_t kMostKeys = 10'000;
constexpr double kMostSeconds = 3600;
/// A foot may leave the ground when so much of the pressure is under the other one.
constexpr double kFreeWeight = 0.9;
constexpr double kRad = kPi / 180;

struct Field {
  const char* name;
  double min, max;
  double scale;  ///< From the file's unit to SI.
  Channel left, right;
};

constexpr Field kMiddle[] = {
    // name      min  max   to SI  channel
    {"crouch_m", 0, 0.45, 1, Channel::kCrouch, Channel::kCrouch},
    {"bow_deg", -15, 90, kRad, Channel::kBow, Channel::kBow},
    {"bend_deg", -30, 30, kRad, Channel::kBend, Channel::kBend},
    {"twist_deg", -60, 60, kRad, Channel::kTwist, Channel::kTwist},
    {"nod_deg", -30, 45, kRad, Channel::kNod, Channel::kNod},
    {"look_deg", -60, 60, kRad, Channel::kLook, Channel::kLook},
    {"weight", -1, 1, 1, Channel::kWeight, Channel::kWeight},
    {"ahead", -1, 1, 1, Channel::kAhead, Channel::kAhead},
};

constexpr Field kPairs[] = {
    {"raise_deg", -85, 75, kRad, Channel::kLeftRaise, Channel::kRightRaise},
    {"front_deg", -10, 110, kRad, Channel::kLeftFront, Channel::kRightFront},
    {"roll_deg", -60, 60, kRad, Channel::kLeftRoll, Channel::kRightRoll},
    {"elbow_deg", 0, 140, kRad, Channel::kLeftElbow, Channel::kRightElbow},
    {"lift_m", 0, 0.4, 1, Channel::kLeftLift, Channel::kRightLift},
    {"step_m", -0.25, 0.25, 1, Channel::kLeftStep, Channel::kRightStep},
    {"out_m", -0.02, 0.25, 1, Channel::kLeftOut, Channel::kRightOut},
};

/// The channels that a name sets, and its range; none when there is no such name.
const Field* FieldNamed(const std::string& name, bool& left, bool& right) {
  left = right = true;
  for (const Field& field : kMiddle) {
    if (name == field.name) return &field;
  }
  for (const Field& field : kPairs) {
    left = name == std::string("left_") + field.name || name == std::string("both_") + field.name;
    right = name == std::string("right_") + field.name || name == std::string("both_") + field.name;
    if (left || right) return &field;
  }
  return nullptr;
}

class Parser {
 public:
  explicit Parser(std::string origin) : origin_(std::move(origin)) {}

  Result<void> AddKeys(const json& keys, bool nested) {
    if (!keys.is_array() || keys.empty()) return Bad("keys must be a list of at least one key");
    for (const json& key : keys) {
      if (key.is_object() && key.contains("repeat")) {
        if (nested) return Bad("a repeat inside a repeat");
        const json count = key["repeat"];
        if (!count.is_number_integer() || count < 1 || count > 1000 || !key.contains("keys") ||
            key.size() != 2) {
          return Bad("a repeat is {\"repeat\": 1 to 1000, \"keys\": [...]}");
        }
        for (int i = 0; i < count.get<int>(); ++i) {
          if (auto added = AddKeys(key["keys"], true); !added) return added;
        }
      } else if (auto added = AddKey(key); !added) {
        return added;
      }
    }
    return {};
  }

  Script script;

 private:
  Error Bad(const std::string& what) const {
    return InvalidData(origin_ + ", key " + std::to_string(script.keys.size() + 1) + ": " + what);
  }

  Result<void> AddKey(const json& object) {
    if (script.keys.size() >= kMostKeys) return Bad("more than 10000 keys");
    if (!object.is_object() || !object.contains("seconds")) {
      return Bad("it must be an object with at least seconds");
    }
    Key key;
    if (!script.keys.empty()) key.values = script.keys.back().values;
    for (const auto& [name, value] : object.items()) {
      if (auto set = Set(name, value, key); !set) return set;
    }
    if (script.duration_s() + key.seconds > kMostSeconds) return Bad("more than an hour");
    if (auto standing = CheckFeet(key); !standing) return standing;
    if (auto steady = CheckHips(key); !steady) return steady;
    script.keys.push_back(key);
    return {};
  }

  Result<void> Set(const std::string& name, const json& value, Key& key) const {
    static constexpr Field kSeconds = {"seconds", 0.05, 600, 1, Channel::kCrouch, Channel::kCrouch};
    bool left = false, right = false;
    const bool is_seconds = name == kSeconds.name;
    const Field* field = is_seconds ? &kSeconds : FieldNamed(name, left, right);
    if (field == nullptr) return Bad("unknown name \"" + name + "\"");
    const double number = value.is_number() ? value.get<double>() : field->min - 1;
    if (!(number >= field->min && number <= field->max)) {
      return Bad(name + " must be a number from " + std::to_string(field->min) + " to " +
                 std::to_string(field->max));
    }
    if (is_seconds) {
      key.seconds = number;
      return {};
    }
    if (left) At(key.values, field->left) = number * field->scale;
    if (right) At(key.values, field->right) = number * field->scale;
    return {};
  }

  /// The fifth-order blend of d in T accelerates by 10 / sqrt(3) d / T^2 at most. At 1 g and more
  /// the body would leave the ground, on which a script has it stand.
  Result<void> CheckHips(const Key& key) const {
    const Values before = script.keys.empty() ? Values{} : script.keys.back().values;
    const double way_m = std::abs(At(key.values, Channel::kCrouch) - At(before, Channel::kCrouch));
    const double least_s = std::sqrt(10 / std::sqrt(3.0) * way_m / (0.9 * kStandardGravityMps2));
    if (key.seconds >= least_s) return {};
    return Bad("crouch_m changes by " + text::Fixed(way_m, 2) + " m in " +
               text::Fixed(key.seconds, 2) + " s, faster than a body falls: give it " +
               text::Fixed(std::ceil(100 * least_s) / 100, 2) + " s or more");
  }

  /// A foot that is off the ground during this key must not carry before or after.
  Result<void> CheckFeet(const Key& key) const {
    const Values before = script.keys.empty() ? Values{} : script.keys.back().values;
    const auto changes = [&](Channel channel) {
      return At(before, channel) != At(key.values, channel);
    };
    const auto up = [&](Channel lift) { return At(before, lift) > 0 || At(key.values, lift) > 0; };
    const bool left =
        up(Channel::kLeftLift) || changes(Channel::kLeftStep) || changes(Channel::kLeftOut);
    const bool right =
        up(Channel::kRightLift) || changes(Channel::kRightStep) || changes(Channel::kRightOut);
    const double least = std::min(At(before, Channel::kWeight), At(key.values, Channel::kWeight));
    const double most = std::max(At(before, Channel::kWeight), At(key.values, Channel::kWeight));
    if (left && most > -kFreeWeight) {
      return Bad("the left foot leaves the ground while it carries; set weight to -1 before");
    }
    if (right && least < kFreeWeight) {
      return Bad("the right foot leaves the ground while it carries; set weight to 1 before");
    }
    return {};
  }

  std::string origin_;
};

}  // namespace

double Script::duration_s() const {
  double sum_s = 0;
  for (const Key& key : keys) sum_s += key.seconds;
  return sum_s;
}

bool Script::EndsInTPose() const {
  return keys.empty() || std::all_of(keys.back().values.begin(), keys.back().values.end(),
                                     [](double value) { return value == 0; });
}

Result<Script> ParseScript(const std::string& text, const std::string& origin) {
  const auto read = text::ParseJson(text, origin);
  if (!read) return read.error();
  const auto& parsed = *read;
  if (!parsed.is_object() || !parsed.contains("keys")) {
    return InvalidData(origin + " must hold a JSON object with keys");
  }
  Parser parser(origin);
  for (const auto& [name, value] : parsed.items()) {
    if (name == "keys") continue;
    if (name != "sway_mm" || !value.is_number() || !(value >= 0 && value <= 10)) {
      return InvalidData(origin + ": \"" + name + "\" must be sway_mm, from 0 to 10");
    }
    parser.script.sway_m = value.get<double>() * 1e-3;
  }
  if (auto added = parser.AddKeys(parsed["keys"], false); !added) return added.error();
  return std::move(parser.script);
}

namespace {

constexpr double kStepLiftM = 0.05;
constexpr double kStepMovesFrom = 0.25;  // Share of a step's time for lifting, and for lowering.

/// From 0 to 1 with velocity and acceleration 0 at both ends.
double Blend(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10 - 15 * u + 6 * u * u);
}

struct FootChannels {
  Channel lift, step, out;
};
constexpr FootChannels kFeet[] = {{Channel::kLeftLift, Channel::kLeftStep, Channel::kLeftOut},
                                  {Channel::kRightLift, Channel::kRightStep, Channel::kRightOut}};

/// A foot that goes elsewhere goes up first, over, and down.
void StepOver(const Values& from, const Values& to, double u, const FootChannels& foot,
              Values& at) {
  const bool steps =
      At(from, foot.step) != At(to, foot.step) || At(from, foot.out) != At(to, foot.out);
  if (!steps) return;
  const double over = Blend((u - kStepMovesFrom) / (1 - 2 * kStepMovesFrom));
  for (const Channel channel : {foot.step, foot.out})
    At(at, channel) = At(from, channel) + over * (At(to, channel) - At(from, channel));
  const double up = Blend(2 * u) * Blend(2 * (1 - u));
  At(at, foot.lift) = std::max(At(at, foot.lift), kStepLiftM * up);
}

}  // namespace

std::vector<Values> Sample(const Script& script, double rate_hz) {
  std::vector<Values> out;
  const auto frames = static_cast<std::size_t>(std::lround(script.duration_s() * rate_hz)) + 1;
  out.reserve(frames);
  std::size_t key = 0;
  double start_s = 0;
  Values from{};
  while (out.size() < frames && key < script.keys.size()) {
    const Key& to = script.keys[key];
    const double into_s = static_cast<double>(out.size()) / rate_hz - start_s;
    if (into_s > to.seconds && key + 1 < script.keys.size()) {
      start_s += to.seconds;
      from = to.values;
      ++key;
      continue;
    }
    const double u = into_s / to.seconds;
    Values at = from;
    for (std::size_t i = 0; i < kChannels; ++i) at[i] += Blend(u) * (to.values[i] - from[i]);
    for (const FootChannels& foot : kFeet) StepOver(from, to.values, u, foot, at);
    out.push_back(at);
  }
  return out;
}

Eigen::Vector2d Sway(double sway_m, double t_s) {
  // Frequencies without a common period; amplitudes fall as in quiet standing.
  struct Part {
    double x_hz, y_hz, amplitude;
  };
  static constexpr Part kParts[] = {
      {0.11, 0.13, 1}, {0.29, 0.23, 0.7}, {0.61, 0.53, 0.35}, {1.07, 0.97, 0.15}};
  double square = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Part& part : kParts) {
    square += 0.5 * part.amplitude * part.amplitude;
    sum += part.amplitude * Eigen::Vector2d(std::sin(2 * kPi * part.x_hz * t_s),
                                            std::sin(2 * kPi * part.y_hz * t_s));
  }
  return sway_m / std::sqrt(square) * sum;
}

}  // namespace footing::choreography
