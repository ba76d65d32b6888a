#include "daemon/sensor/kinds/kind.h"

#include <array>
#include <type_traits>
#include <utility>

namespace footing::kinds {
namespace {

template <typename One>
concept HasSequencer = requires(One& one) {
  one.sequencer();
};

template <typename... Every>
constexpr std::size_t CountOfPlans(std::type_identity<std::variant<Every...>>) {
  return (std::size_t{HasSequencer<Every>} + ...);
}

constexpr std::type_identity<Alternatives> kAll;

template <typename... Every>
constexpr auto CollectPlans(std::type_identity<std::variant<Every...>>) {
  std::array<const handshake::Plan*, CountOfPlans(std::type_identity<std::variant<Every...>>())>
      plans{};
  std::size_t count = 0;
  const auto add = [&]<typename One>(std::type_identity<One>) {
    if constexpr (HasSequencer<One>) plans[count++] = &One::kPlan;
  };
  (add(std::type_identity<Every>()), ...);
  return plans;
}

constexpr auto kPlans = CollectPlans(kAll);

template <typename One>
Alternatives MakeOne(const decode::KindOptions& options, const decode::Product& product,
                     const Stored& stored) {
  if constexpr (HasSequencer<One>) {
    return One(options, handshake::HandshakeSequencer(options.handshake, One::kPlan, kPlans));
  } else {
    return One(product, stored);
  }
}

/// The first that matches; the last matches everything.
template <typename First, typename... Rest>
Alternatives Make(std::type_identity<std::variant<First, Rest...>>,
                  const decode::KindOptions& options, const decode::Product& product,
                  const Stored& stored) {
  if constexpr (sizeof...(Rest) > 0) {
    if (!First::Matches(product)) {
      return Make(std::type_identity<std::variant<Rest...>>(), options, product, stored);
    }
  }
  return MakeOne<First>(options, product, stored);
}

/// The kind of that plan, with the sequencer as it is.
template <typename... Every>
Alternatives MakeOf(std::type_identity<std::variant<Every...>>, const decode::KindOptions& options,
                    Alternatives&& before, handshake::HandshakeSequencer sequencer) {
  const handshake::Plan* plan = &sequencer.plan();
  Alternatives after = std::move(before);
  const auto take = [&]<typename One>(std::type_identity<One>) {
    if constexpr (HasSequencer<One>) {
      if (plan == &One::kPlan) after = One(options, std::move(sequencer));
    }
  };
  (take(std::type_identity<Every>()), ...);
  return after;
}

}  // namespace

std::span<const handshake::Plan* const> Plans() { return kPlans; }

Kind::Kind(const decode::KindOptions& options, const decode::Product& product, const Stored& stored)
    : options_(options), alternatives_(Make(kAll, options, product, stored)) {}

stream::DeviceKind Kind::kind() const {
  return std::visit([](const auto& one) { return one.kKind; }, alternatives_);
}

decode::Placement Kind::placement() const {
  return std::visit([](const auto& one) { return one.kPlacement; }, alternatives_);
}

decode::Timing Kind::timing() const {
  return std::visit([](const auto& one) { return one.kTiming; }, alternatives_);
}

const handshake::HandshakeSequencer* Kind::sequencer() const {
  return std::visit(
      [](const auto& one) -> const handshake::HandshakeSequencer* {
        if constexpr (HasSequencer<decltype(one)>) return &one.sequencer();
        return nullptr;
      },
      alternatives_);
}

bool Kind::live() const {
  return std::visit(
      [](const auto& one) {
        if constexpr (HasSequencer<decltype(one)>) {
          return one.sequencer().live();
        } else {
          return one.live();
        }
      },
      alternatives_);
}

void Kind::Restart() {
  std::visit(
      [](auto& one) {
        if constexpr (requires { one.Restart(); }) one.Restart();
      },
      alternatives_);
}

/// Follows the plan of the device that answers at the port; it may have read a block too.
void Kind::FollowPlan() {
  const bool other = std::visit(
      []<typename One>(const One& one) {
        if constexpr (HasSequencer<One>) {
          return &one.sequencer().plan() != &One::kPlan;
        } else {
          return false;
        }
      },
      alternatives_);
  if (other) {
    handshake::HandshakeSequencer sequencer = *this->sequencer();
    alternatives_ = MakeOf(kAll, options_, std::move(alternatives_), std::move(sequencer));
  }
  std::visit(
      [](auto& one) {
        if constexpr (requires { one.TakeBlocks(); }) one.TakeBlocks();
      },
      alternatives_);
}

void Kind::Advance(std::int64_t now_ns, Outputs& outputs) {
  std::visit(
      [&](auto& one) {
        if constexpr (HasSequencer<decltype(one)>) one.sequencer().Advance(now_ns, outputs);
      },
      alternatives_);
  FollowPlan();
}

std::optional<decode::Decoded> Kind::Take(std::int64_t received_ns, reports::Bytes report,
                                          Outputs& outputs) {
  if (sequencer() == nullptr) {
    return std::visit(
        [&](auto& one) -> std::optional<decode::Decoded> {
          if constexpr (HasSequencer<decltype(one)>) {
            return std::nullopt;
          } else {
            return one.Take(report);
          }
        },
        alternatives_);
  }
  const reports::InputReport decoded = reports::Decode(report);
  if (std::holds_alternative<reports::Undecodable>(decoded.body)) return std::nullopt;
  std::visit(
      [&](auto& one) {
        if constexpr (HasSequencer<decltype(one)>) {
          one.sequencer().Take(received_ns, decoded, outputs);
        }
      },
      alternatives_);
  FollowPlan();
  if (!live()) return decode::Decoded();
  return std::visit(
      [&](auto& one) {
        if constexpr (HasSequencer<decltype(one)>) return one.Take(decoded);
        return decode::Decoded();
      },
      alternatives_);
}

std::optional<reports::OutputReport> Kind::NextOutput(std::int64_t now_ns, link::Outbox& outbox) {
  return std::visit(
      [&](auto& one) {
        if constexpr (requires { one.NextOutput(now_ns, true); }) {
          return one.NextOutput(now_ns, outbox.rumble());
        } else {
          return outbox.Next(now_ns);
        }
      },
      alternatives_);
}

reports::OutputReport Kind::MotorOff() const {
  return std::visit(
      [](const auto& one) {
        if constexpr (requires { one.MotorOff(); }) {
          return one.MotorOff();
        } else {
          return reports::RumbleOnly();
        }
      },
      alternatives_);
}

bool Kind::has_second_link() const {
  return std::visit(
      [](const auto& one) {
        return requires { one.kHasSecondLink; };
      },
      alternatives_);
}

void Kind::TakeSecondLink() {
  std::visit(
      [](auto& one) {
        if constexpr (requires { one.TakeSecondLink(); }) one.TakeSecondLink();
      },
      alternatives_);
}

std::optional<decode::FeatureRequest> Kind::NextFeature(std::int64_t now_ns) {
  return std::visit(
      [&](auto& one) -> std::optional<decode::FeatureRequest> {
        if constexpr (requires { one.NextFeature(now_ns); }) return one.NextFeature(now_ns);
        return std::nullopt;
      },
      alternatives_);
}

Stored Kind::TakeFeature(reports::Bytes feature) {
  return std::visit(
      [&](auto& one) -> Stored {
        if constexpr (requires { one.TakeFeature(feature); }) return one.TakeFeature(feature);
        return std::nullopt;
      },
      alternatives_);
}

bool Kind::has_lamps() const { return sequencer() != nullptr; }

bool Kind::SetSphere(std::uint32_t rgb) {
  return std::visit(
      [&](auto& one) {
        if constexpr (requires { one.SetSphere(rgb); }) {
          one.SetSphere(rgb);
          return true;
        }
        return false;
      },
      alternatives_);
}

bool Kind::SetCamera(bool on) {
  return std::visit(
      [&](auto& one) {
        if constexpr (requires { one.SetCamera(on); }) {
          one.SetCamera(on);
          return true;
        }
        return false;
      },
      alternatives_);
}

bool Kind::RequestStatus(std::int64_t now_ns) {
  return std::visit(
      [&](auto& one) {
        if constexpr (HasSequencer<decltype(one)>) return one.sequencer().RequestStatus(now_ns);
        return false;
      },
      alternatives_);
}

void Kind::AddTo(stream::DeviceStatus& status) const {
  status.kind = kind();
  if (const handshake::HandshakeSequencer* one = sequencer()) {
    status.extension = one->extension();
    status.mode_reasserts = one->mode_reasserts();
  }
  std::visit([&](const auto& one) { one.AddTo(status); }, alternatives_);
}

std::string Kind::Note(std::int64_t now_ns) const {
  if (const handshake::HandshakeSequencer* one = sequencer()) {
    const std::string note = one->Note(now_ns);
    if (!note.empty() || !one->live()) return note;
  }
  return std::visit([](const auto& one) { return one.Note(); }, alternatives_);
}

}  // namespace footing::kinds
