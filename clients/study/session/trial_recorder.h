#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "clients/study/session/console.h"
#include "common/recording/records.h"
#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::study {

/// Records everything that both servers publish during one trial, in one file (MCAP) as footing-log
/// does. It has connections of its own: each begins with what is retained, such as the track, and a
/// slow disk disturbs no other connection.
class TrialRecorder {
 public:
  struct Options {
    std::string path;  ///< Must not exist.
    std::string version;
    std::vector<transport::Address> addresses;
    std::vector<std::pair<std::string, std::string>> attachments;  ///< Name and text.
  };

  /// `marks` is the metadata record "trial".
  static Result<std::unique_ptr<TrialRecorder>> Begin(Console& console, Options options,
                                                      const mcap::TextMap& marks);
  ~TrialRecorder();
  TrialRecorder(const TrialRecorder&) = delete;
  TrialRecorder& operator=(const TrialRecorder&) = delete;

  /// Returns when something of every server has arrived.
  Result<void> AwaitFirst(Console& console) const;
  /// A full disk, as soon as it is noticed.
  const Result<void>& written() const;
  /// Runs until everything up to this instant is in the file, for a short while at most: events
  /// reach other connections first. A server with another clock is waited for in vain.
  Waited CatchUp(Console& console, std::int64_t host_ns) const;
  /// Ends the file; `outcome` is the metadata record "trial_outcome".
  Result<void> Finish(const mcap::TextMap& outcome);

 private:
  class Implementation;
  explicit TrialRecorder(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace footing::study
