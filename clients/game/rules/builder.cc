#include "clients/game/rules/builder.h"

#include <algorithm>

#include "common/body/centre_line.h"

namespace footing::game {
namespace {

constexpr double kAheadS = 3;
constexpr double kLeastAheadM = 6, kMostAheadM = 12;
/// A piece that does not show within this is lost: the next one goes out.
constexpr double kAnswerS = 1;

}  // namespace

double LookAheadM(double speed_mps) {
  return std::clamp(kAheadS * speed_mps, kLeastAheadM, kMostAheadM);
}

std::optional<Piece> Builder::Advance(const Sight& sight, const Hand& hand) {
  ghost_ = Held(plain_ ? Hand{} : hand, sight.track, sight.speed_mps, pits_);
  if (sent_s_) {
    const bool shown = sight.track.revision != sent_revision_;
    if (!shown && sight.time_s - *sent_s_ < kAnswerS) return std::nullopt;
    if (shown) plain_ = false;
    sent_s_.reset();
    ghost_ = Held(plain_ ? Hand{} : hand, sight.track, sight.speed_mps, pits_);
  }
  if (track::LengthOf(sight.track) - sight.distance_m >= LookAheadM(sight.speed_mps))
    return std::nullopt;
  sent_s_ = sight.time_s;
  sent_revision_ = sight.track.revision;
  return ghost_;
}

void Builder::OnRefused() {
  ++refused_;
  plain_ = true;
  sent_s_.reset();
}

void Builder::Restart() {
  sent_s_.reset();
  plain_ = false;
}

}  // namespace footing::game
