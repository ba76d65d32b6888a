#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "footing/v1/session.pb.h"

namespace footing::transport {

/// The commands of a client that wait for their answers. Each gets exactly one call of `done`.
class PendingCommands {
 public:
  using Done = std::function<void(const v1::CommandResult&)>;

  /// Gives the command its id and waits for its answer until its deadline. Nothing, and `done` is
  /// called, when too many wait already.
  std::optional<v1::Command> Add(v1::Command command, const Done& done, std::int64_t now_ns);
  /// Refuses a command that cannot be sent.
  void Refuse(const Done& done, const std::string& why);
  void TakeAnswer(const v1::CommandResult& answer);
  /// Fails those whose deadline has passed.
  void Expire(std::int64_t now_ns);
  /// Fails all.
  void Fail(const std::string& why);

 private:
  struct Waiting {
    Done done;
    std::int64_t deadline_ns = 0;
  };

  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, Waiting> waiting_;
};

}  // namespace footing::transport
