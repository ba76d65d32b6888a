#include "clients/study/plan/phases.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include "common/base/text.h"
#include "common/stream/leg_turn.h"
#include "common/stream/roles.h"

namespace footing::study::plan {
namespace {

/// Gives out a list in random order, again and again.
class Deck {
 public:
  Deck(std::vector<std::string> cards, Draw draw) : cards_(std::move(cards)), draw_(draw) {}

  std::string Next() {
    if (cards_.empty()) return "";
    if (next_ % cards_.size() == 0) draw_.Shuffle(cards_);
    return cards_[next_++ % cards_.size()];
  }

 private:
  std::vector<std::string> cards_;
  Draw draw_;
  std::size_t next_ = 0;
};

struct Decks {
  Deck tasks;
  Deck tracks;
};

void AddInterface(const Protocol& protocol, const std::string& participant,
                  const std::string& interface, bool first, Decks& decks,
                  std::vector<Phase>& phases) {
  const auto add = [&](PhaseKind kind, const std::string& name) -> Phase& {
    Phase& phase = phases.emplace_back();
    phase.id = interface + "." + name;
    phase.kind = kind;
    phase.interface = interface;
    constexpr std::uint64_t kBits53 = (1ull << 53) - 1;
    phase.seed = Draw(protocol.seed, "trial " + participant + " " + phase.id).Bits() & kBits53;
    return phase;
  };
  if (const double rest_s = protocol.rests.between_s; !first && rest_s > 0) {
    add(PhaseKind::kRest, "rest").duration_s = rest_s;
  }
  add(PhaseKind::kDemonstration, "demonstration").track = protocol.practice_track;
  if (protocol.settings.personal_ranges) {
    add(PhaseKind::kRanges, "ranges").track = protocol.practice_track;
  }
  if (protocol.practice_s > 0) {
    Phase& practice = add(PhaseKind::kPractice, "practice");
    practice.track = protocol.practice_track;
    practice.duration_s = protocol.practice_s;
  }
  for (std::uint64_t i = 1; i <= protocol.straight_trials; ++i) {
    Phase& straight = add(PhaseKind::kStraight, "straight" + std::to_string(i));
    straight.track = protocol.straight_track;
    straight.task = decks.tasks.Next();
  }
  if (!protocol.test_tracks.empty()) {
    add(PhaseKind::kTestTrack, "test").track = decks.tracks.Next();
  }
  add(PhaseKind::kSurvey, "survey");
}

SessionPlan MakeSession(const Protocol& protocol, const std::string& participant,
                        const std::vector<std::size_t>& order) {
  SessionPlan session;
  session.participant = participant;
  Decks decks{Deck(protocol.straight_tasks, Draw(protocol.seed, "tasks " + participant)),
              Deck(protocol.test_tracks, Draw(protocol.seed, "tracks " + participant))};
  session.phases.push_back({"consent", PhaseKind::kConsent, "", "", "", 0, 0});
  session.phases.push_back({"device_check", PhaseKind::kDeviceCheck, "", "", "", 0, 0});
  for (const std::size_t i : order) {
    const std::string& interface = protocol.interfaces[i];
    AddInterface(protocol, participant, interface, session.interfaces.empty(), decks,
                 session.phases);
    session.interfaces.push_back(interface);
  }
  session.phases.push_back({"final_survey", PhaseKind::kFinalSurvey, "", "", "", 0, 0});
  return session;
}

}  // namespace

const char* Name(PhaseKind kind) {
  switch (kind) {
    case PhaseKind::kConsent:
      return "consent";
    case PhaseKind::kDeviceCheck:
      return "device_check";
    case PhaseKind::kRest:
      return "rest";
    case PhaseKind::kDemonstration:
      return "demonstration";
    case PhaseKind::kRanges:
      return "ranges";
    case PhaseKind::kPractice:
      return "practice";
    case PhaseKind::kStraight:
      return "straight";
    case PhaseKind::kTestTrack:
      return "test_track";
    case PhaseKind::kSurvey:
      return "survey";
    case PhaseKind::kFinalSurvey:
      return "final_survey";
  }
  return "";
}

std::size_t SessionPlan::trial_count() const {
  return static_cast<std::size_t>(std::count_if(
      phases.begin(), phases.end(), [](const Phase& phase) { return phase.is_trial(); }));
}

std::vector<SessionPlan> MakeSessions(const Protocol& protocol) {
  const std::size_t people = protocol.participants.size();
  const std::size_t count = protocol.interfaces.size();
  const Orders orders = protocol.order == Order::kWilliams
                            ? BalancedOrders(count, people, protocol.seed)
                            : RandomOrders(count, people, protocol.seed);
  std::vector<SessionPlan> sessions;
  for (std::size_t i = 0; i < people; ++i) {
    sessions.push_back(MakeSession(protocol, protocol.participants[i], orders[i]));
  }
  return sessions;
}

namespace {

/// Interfaces that every participant uses on the same test track, where there are several.
void AddConfounded(const Protocol& protocol, std::vector<std::string>& remarks) {
  if (protocol.participants.size() < 2 || protocol.test_tracks.size() < 2) return;
  std::map<std::string, std::set<std::string>> tracks;  // Tracks of each interface.
  for (const SessionPlan& session : MakeSessions(protocol)) {
    for (const Phase& phase : session.phases) {
      if (phase.kind == PhaseKind::kTestTrack) tracks[phase.interface].insert(phase.track);
    }
  }
  for (const auto& [interface, met] : tracks) {
    if (met.size() != 1) continue;
    remarks.push_back("every participant uses " + interface + " on test track " + *met.begin() +
                      ": the effects of the two cannot be separated; choose another seed");
  }
}

}  // namespace

std::vector<std::string> Remarks(const Protocol& protocol) {
  std::vector<std::string> remarks;
  const std::size_t rows = WilliamsOrders(protocol.interfaces.size()).size();
  const std::size_t people = protocol.participants.size();
  if (protocol.order == Order::kWilliams && people % rows != 0) {
    remarks.push_back("the order is not fully balanced: " + std::to_string(people) +
                      (people == 1 ? " participant" : " participants") + ", and a square has " +
                      std::to_string(rows) + " rows; plan a multiple of " + std::to_string(rows));
  }
  if (protocol.test_tracks.size() > 0 && protocol.test_tracks.size() < protocol.interfaces.size()) {
    remarks.push_back("there are fewer test tracks than interfaces: a participant meets one twice");
  }
  AddConfounded(protocol, remarks);
  if (protocol.devices.allow_simulated) {
    remarks.push_back("simulated devices are allowed: for trying out, not for a study");
  }
  return remarks;
}

namespace {

std::vector<std::size_t> UpTo(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

/// 0, 1, n - 1, 2, n - 2, ...: its neighbours' differences are all different when n is even.
std::vector<std::size_t> FirstRow(std::size_t count) {
  std::vector<std::size_t> row;
  for (std::size_t i = 0; i < count; ++i) {
    row.push_back(i == 0 ? 0 : i % 2 == 1 ? (i + 1) / 2 : count - i / 2);
  }
  return row;
}

}  // namespace

Orders WilliamsOrders(std::size_t count) {
  Orders orders;
  const std::vector<std::size_t> first = FirstRow(count);
  for (std::size_t shift = 0; shift < count; ++shift) {
    std::vector<std::size_t> row;
    for (const std::size_t condition : first) row.push_back((condition + shift) % count);
    orders.push_back(std::move(row));
  }
  if (count % 2 == 1 && count > 1) {
    for (std::size_t i = 0; i < count; ++i) {
      orders.emplace_back(orders[i].rbegin(), orders[i].rend());
    }
  }
  return orders;
}

Orders BalancedOrders(std::size_t count, std::size_t participants, std::uint64_t seed) {
  Orders orders;
  Draw draw(seed, "order");
  const Orders square = WilliamsOrders(count);
  while (orders.size() < participants) {
    std::vector<std::size_t> names = UpTo(count);
    std::vector<std::size_t> rows = UpTo(square.size());
    draw.Shuffle(names);
    draw.Shuffle(rows);
    for (const std::size_t row : rows) {
      if (orders.size() == participants) break;
      std::vector<std::size_t> order;
      for (const std::size_t condition : square[row]) order.push_back(names[condition]);
      orders.push_back(std::move(order));
    }
  }
  return orders;
}

Orders RandomOrders(std::size_t count, std::size_t participants, std::uint64_t seed) {
  Orders orders;
  for (std::size_t i = 0; i < participants; ++i) {
    std::vector<std::size_t> order = UpTo(count);
    Draw(seed, "order " + std::to_string(i)).Shuffle(order);
    orders.push_back(std::move(order));
  }
  return orders;
}

/// FNV-1a, started with the seed.
Draw::Draw(std::uint64_t seed, std::string_view purpose) {
  std::uint64_t hash = text::kFnvBasis;
  const auto mix = [&hash](unsigned char byte) { hash = text::AddFnv(hash, byte); };
  for (int i = 0; i < 8; ++i) mix(static_cast<unsigned char>(seed >> (8 * i)));
  for (const char c : purpose) mix(static_cast<unsigned char>(c));
  engine_.seed(hash);
}

std::size_t Draw::Below(std::size_t count) {
  constexpr std::uint64_t kGreatest = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t whole = kGreatest - kGreatest % count;  // A multiple: no remainder is rarer.
  for (;;) {
    const std::uint64_t bits = engine_();
    if (bits < whole) return static_cast<std::size_t>(bits % count);
  }
}

std::vector<stream::DeviceRole> RolesOf(const Played& played) {
  return stream::RolesOf(stream::UserInterfaceNamed(played.interface),
                         stream::LegTurnSourceNamed(played.turn_by));
}

}  // namespace footing::study::plan
