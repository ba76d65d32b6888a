#include "common/guide/step.h"

namespace footing::guide {

const char* Name(Item item) {
  switch (item) {
    case Item::kAdapter:
      return "adapter";
    case Item::kPairing:
      return "pairing";
    case Item::kRoles:
      return "roles";
    case Item::kLayout:
      return "layout";
    case Item::kTare:
      return "tare";
    case Item::kMounting:
      return "mounting";
    case Item::kWeigh:
      return "weigh";
    case Item::kCamera:
      return "camera";
    case Item::kChecks:
      return "checks";
  }
  return "";
}

const std::vector<Item>& AllItems() {
  static const std::vector<Item> items{Item::kAdapter, Item::kPairing, Item::kRoles,
                                       Item::kLayout,  Item::kTare,    Item::kMounting,
                                       Item::kWeigh,   Item::kCamera,  Item::kChecks};
  return items;
}

std::optional<Item> ItemNamed(const std::string& name) {
  for (const Item item : AllItems()) {
    if (name == Name(item)) return item;
  }
  return std::nullopt;
}

stream::SetupItem Outcome(Item item, const std::string& serial, bool passed, double residual,
                          const std::string& unit, const std::string& note) {
  stream::SetupItem outcome;
  outcome.name = Name(item);
  outcome.serial = serial;
  outcome.passed = passed;
  outcome.residual = residual;
  outcome.unit = unit;
  outcome.note = note;
  return outcome;
}

}  // namespace footing::guide
