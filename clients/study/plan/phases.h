#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clients/study/plan/protocol.h"
#include "common/stream/device.h"

namespace footing::study::plan {

/// Kinds of the phases of a session.
enum class PhaseKind {
  kConsent,
  kDeviceCheck,
  kRest,
  kDemonstration,
  kRanges,
  kPractice,
  kStraight,
  kTestTrack,
  kSurvey,
  kFinalSurvey,
};

const char* Name(PhaseKind kind);

/// A part of a session. It is done as a whole: a session that broke off goes on with the phase that
/// was not finished.
struct Phase {
  std::string id;  ///< Unique within a session, such as "wrist.straight1".
  PhaseKind kind = PhaseKind::kConsent;
  std::string interface;   ///< Empty: of the whole session.
  std::string track;       ///< Track of trials, practice and demonstration.
  std::string task;        ///< Task on the straight track.
  double duration_s = 0;   ///< Duration of practice and rest.
  std::uint64_t seed = 0;  ///< Seed of trials; at most 53 bits.

  bool is_trial() const { return kind == PhaseKind::kStraight || kind == PhaseKind::kTestTrack; }
};

/// Schedule of one participant, from the consent to the final survey (gait paper, section 8.1): for
/// each interface the demonstration, the measurement of personal ranges where the protocol wants
/// it, practice, the straight tracks, one test track, the survey.
struct SessionPlan {
  std::string participant;
  std::vector<std::string> interfaces;  ///< In their order.
  std::vector<Phase> phases;

  std::size_t trial_count() const;
};

/// The sessions of all participants, in the protocol's order. Straight tasks and test tracks are
/// drawn without replacement as far as they last.
std::vector<SessionPlan> MakeSessions(const Protocol& protocol);

/// Remarks on the plan for the experimenter, such as an incomplete square.
std::vector<std::string> Remarks(const Protocol& protocol);

/// Orders in which participants use the interfaces: permutations of 0 to count - 1.
using Orders = std::vector<std::vector<std::size_t>>;

/// The Latin square of Williams (1949): every condition equally often at each position, and equally
/// often right after each other one. An even count needs `count` rows, an odd one twice as many.
Orders WilliamsOrders(std::size_t count);

/// An order for each participant from whole squares: the rows of each square come in random order
/// and the conditions are dealt to its columns at random.
Orders BalancedOrders(std::size_t count, std::size_t participants, std::uint64_t seed);

/// An independent random order for each participant.
Orders RandomOrders(std::size_t count, std::size_t participants, std::uint64_t seed);

/// Random numbers of one purpose: the seed of the protocol and a label give the same numbers on
/// every machine, and a further purpose does not shift those of the others.
class Draw {
 public:
  Draw(std::uint64_t seed, std::string_view purpose);

  /// A whole number in [0, count), each as likely. `count` is at least 1.
  std::size_t Below(std::size_t count);
  std::uint64_t Bits() { return engine_(); }

  template <typename Value>
  void Shuffle(std::vector<Value>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[Below(i)]);
  }

 private:
  std::mt19937_64 engine_;
};

/// Interface with which a participant commands the character.
struct Played {
  std::string interface;         ///< Name of a stream::UserInterface.
  std::string turn_by = "head";  ///< Turn source of the interface leg: head, trunk or feet.
};

/// The roles of its devices, as stream::RolesOf.
std::vector<stream::DeviceRole> RolesOf(const Played& played);

}  // namespace footing::study::plan
