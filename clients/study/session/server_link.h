#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "clients/study/session/console.h"
#include "common/net/client.h"
#include "common/runtime/timer.h"

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

  /// Takes a state from the client's handler on_state.
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

/// Options of a session's connection to a server.
struct ServerLinkOptions {
  std::string server;  ///< "footingd" or "footing-sim".
  transport::Address address;
  std::vector<std::string> channels;
  std::string holder;  ///< Holder of the server's lease.
};

/// Callbacks of a session's connection to a server.
struct ServerLinkHandlers {
  std::function<void(const v1::Tick&)> on_tick;
  std::function<void()> on_down;  ///< The connection is lost and is being restored.
};

/// A session's connection to one server, with that server's lease. A connection that breaks goes on
/// where it was: the server keeps the ticks of that time.
class ServerLink {
 public:
  ServerLink(Console& console, ServerLinkOptions options, ServerLinkHandlers handlers);
  ~ServerLink();
  ServerLink(const ServerLink&) = delete;
  ServerLink& operator=(const ServerLink&) = delete;

  transport::Client& client();
  HeldLease& lease();
  const HeldLease& lease() const;
  const std::string& name() const;  ///< "footingd at unix:...".
  /// State of the connection, for a person.
  std::string Text() const;

  /// The server is there and does not let this program in.
  bool refused() const;
  /// Connected, and the lease is held where it is wanted.
  bool up() const;
  /// A trial cannot go on: the server was restarted, ticks are missing, the lease was taken over,
  /// or the link has been down for 4 s.
  bool broken() const;
  /// Times that it was down.
  std::uint64_t breaks() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace footing::study
