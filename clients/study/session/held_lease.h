#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "common/runtime/timer.h"
#include "common/net/client.h"

namespace footing::study {

/// Takes a server's lease for one connection and renews it, on the thread of the io_context. A
/// refused lease is asked for again and again; one that was held and is refused is lost for good:
/// somebody has taken it over. Wanted from the start. Owned by a shared_ptr.
class HeldLease : public std::enable_shared_from_this<HeldLease> {
 public:
  /// `client` must outlive this.
  HeldLease(boost::asio::io_context& io, transport::Client& client, std::string holder);
  HeldLease(const HeldLease&) = delete;
  HeldLease& operator=(const HeldLease&) = delete;

  /// From the client's handler on_state.
  void OnState(transport::LinkState state);
  /// Wants the lease again after Release().
  void Hold();
  /// Gives the lease back; `done` is called with the answer, at once when there is no link.
  void Release(std::function<void()> done);

  bool wanted() const { return wanted_; }
  bool held() const { return state_ == State::kHeld; }
  bool lost() const { return state_ == State::kLost; }
  /// The refusal of the server; empty: none.
  const std::string& refusal() const { return refusal_; }

 private:
  enum class State { kNone, kHeld, kRefused, kLost };

  void Ask();
  void AskLater();
  void OnAnswer(std::uint64_t hold, const v1::CommandResult& answer);

  timer::Timer timer_;
  transport::Client& client_;
  const std::string holder_;
  bool connected_ = false;
  bool wanted_ = true;
  std::uint64_t hold_ = 1;  ///< Counts up with Hold(): older answers are of no interest.
  State state_ = State::kNone;
  std::string refusal_;
};

}  // namespace footing::study
