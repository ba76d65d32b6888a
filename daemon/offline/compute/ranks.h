#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "common/base/result.h"

/// Work that outgrows one machine: the same program runs on several at once, as ranks of one run of
/// MPI (`mpirun -n 4 footing-tune ...`).
namespace footing::ranks {

/// The ranks of this run; a program that mpirun did not start is the only one. All ranks do the
/// same in the same order, but each a part of the trials; Share gives all of them what each came
/// to. Only the first one writes files and shows results.
class Ranks {
 public:
  /// One rank, which needs no MPI.
  Ranks() = default;

  /// Asks the environment whether mpirun started this process, and only then begins with MPI. Usage
  /// error when it did and this build has no MPI: each rank would take itself for the only one.
  static Result<Ranks> Join();

  std::size_t rank() const { return rank_; }
  std::size_t count() const { return count_; }
  bool first() const { return rank_ == 0; }

  /// Gathers each rank's value, in the order of the ranks, on all of them.
  std::vector<std::string> Share(const std::string& own) const;
  /// Sends the first rank's value to all of them.
  std::string OfFirst(const std::string& own) const;

  /// The same with values, which must be plain: all ranks are of one build. Those of the first rank
  /// come first.
  template <typename T>
  std::vector<std::vector<T>> Share(const std::vector<T>& own) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<std::vector<T>> shared;
    const auto* bytes = reinterpret_cast<const char*>(own.data());
    for (const std::string& of : Share(std::string(bytes, own.size() * sizeof(T)))) {
      auto& values = shared.emplace_back(of.size() / sizeof(T));
      if (!values.empty()) std::memcpy(values.data(), of.data(), of.size());
    }
    return shared;
  }

  /// To be called last, with the exit code, which it returns. A rank that fails ends all of them.
  int Leave(int exit_code) const;

 private:
  std::size_t rank_ = 0;
  std::size_t count_ = 1;
};

}  // namespace footing::ranks
