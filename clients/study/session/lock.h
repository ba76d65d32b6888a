#pragma once

#include <string>

#include "common/base/result.h"

namespace footing::study::journal {

/// Held by the one study program that runs sessions of a study, or writes into the journal of a
/// participant; gone with the process, however it ends. The file says who holds it.
class Lock {
 public:
  /// A failure that names `what` it is for and the holder, when another process has it.
  static Result<Lock> Take(const std::string& path, const std::string& what,
                           const std::string& holder);

  Lock(Lock&& other) noexcept;
  Lock& operator=(Lock&& other) noexcept;
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  ~Lock();

 private:
  explicit Lock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace footing::study::journal
