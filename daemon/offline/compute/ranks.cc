#include "daemon/offline/compute/ranks.h"

#include <cstdlib>

#ifdef FOOTING_MPI
#include <mpi.h>
#endif

namespace footing::ranks {
namespace {

/// Open MPI's mpirun sets both, another launcher with PMIx the second.
bool StartedAsRank() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMIX_RANK") != nullptr;
}

}  // namespace

#ifdef FOOTING_MPI

Result<Ranks> Ranks::Join() {
  Ranks ranks;
  if (!StartedAsRank()) return ranks;
  int given = 0, rank = 0, count = 1;
  // Threads work, but this one alone speaks with the other ranks. An error of MPI ends the run.
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  ranks.rank_ = static_cast<std::size_t>(rank);
  ranks.count_ = static_cast<std::size_t>(count);
  return ranks;
}

std::vector<std::string> Ranks::Share(const std::string& own) const {
  if (count_ == 1) return {own};
  const int size = static_cast<int>(own.size());
  std::vector<int> sizes(count_), places(count_);
  MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, MPI_COMM_WORLD);
  int sum = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    places[i] = sum;
    sum += sizes[i];
  }
  std::string all(static_cast<std::size_t>(sum), '\0');
  MPI_Allgatherv(own.data(), size, MPI_CHAR, all.data(), sizes.data(), places.data(), MPI_CHAR,
                 MPI_COMM_WORLD);
  std::vector<std::string> shared;
  for (std::size_t i = 0; i < count_; ++i) {
    shared.push_back(
        all.substr(static_cast<std::size_t>(places[i]), static_cast<std::size_t>(sizes[i])));
  }
  return shared;
}

int Ranks::Leave(int exit_code) const {
  int begun = 0;
  MPI_Initialized(&begun);
  if (begun == 0) return exit_code;
  if (exit_code != 0) MPI_Abort(MPI_COMM_WORLD, exit_code);
  MPI_Finalize();
  return exit_code;
}

#else

Result<Ranks> Ranks::Join() {
  if (!StartedAsRank()) return Ranks();
  return UsageError(
      "mpirun started this program, which was built without MPI; install libopenmpi-dev and build "
      "it again, or run it by itself");
}

std::vector<std::string> Ranks::Share(const std::string& own) const { return {own}; }

int Ranks::Leave(int exit_code) const { return exit_code; }

#endif

std::string Ranks::OfFirst(const std::string& own) const {
  return Share(first() ? own : std::string()).front();
}

}  // namespace footing::ranks
