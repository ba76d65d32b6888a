#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "common/timer/timer.h"
#include "common/transport/client.h"

namespace footing::study {

/// Takes footing-sim's lease for one connection and renews it, on the thread of the io_context. A
/// refused lease is asked for again and again; one that was held and is refused is lost for good:
/// somebody has taken it over. Owned by a shared_ptr.
class HeldLease : public std::enable_shared_from_this<HeldLease> {
 public:
  /// `client` must outlive this.
  HeldLease(boost::asio::io_context& io, transport::Client& client, std::string holder);
  HeldLease(const HeldLease&) = delete;
  HeldLease& operator=(const HeldLease&) = delete;

  /// From the client's handler on_state.
  void OnState(transport::LinkState state);
  /// Gives the lease back; `done` is called with the answer, at once when there is no link.
  void Release(std::function<void()> done);

  bool held() const { return state_ == State::kHeld; }
  bool lost() const { return state_ == State::kLost; }
  /// The refusal of footing-sim; empty: none.
  const std::string& refusal() const { return refusal_; }

 private:
  enum class State { kNone, kHeld, kRefused, kLost };

  void Ask();
  void AskLater();
  void OnAnswer(const v1::CommandResult& answer);

  timer::Timer timer_;
  transport::Client& client_;
  const std::string holder_;
  bool connected_ = false;
  State state_ = State::kNone;
  std::string refusal_;
};

}  // namespace footing::study
