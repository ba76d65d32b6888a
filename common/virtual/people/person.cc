#include "common/virtual/people/person.h"

namespace footing::users {
namespace {

using stream::UserInterface;

std::variant<LimbBody, StickBody, BoardBody> BodyFor(UserInterface interface, const Style& style,
                                                     std::uint64_t seed,
                                                     stream::TurnSource turn_by) {
  switch (interface) {
    case UserInterface::kUnspecified:
    case UserInterface::kWrist:
    case UserInterface::kArm:
    case UserInterface::kLeg:
      break;
    case UserInterface::kJoystick:
      return StickBody(style, seed);
    case UserInterface::kBoards:
      return BoardBody(style, seed);
  }
  return LimbBody(interface, style, seed, turn_by);
}

}  // namespace

Person::Person(UserInterface interface, const Style& style, std::uint64_t seed,
               stream::TurnSource turn_by)
    : body_(BodyFor(interface, style, seed, turn_by)) {}

void Person::Advance(double time_s, const Intention& wanted) {
  std::visit(
      [&](auto& body) {
        for (; time_s_ + kStepS <= time_s; time_s_ += kStepS) body.Advance(wanted, kStepS);
        body.Feel(felt_);
      },
      body_);
}

stream::Gait Person::gesture() const {
  return std::visit([](const auto& body) { return body.gesture(); }, body_);
}

double Person::limb_hz() const {
  return std::visit([](const auto& body) { return body.limb_hz(); }, body_);
}

}  // namespace footing::users
