#include <gtest/gtest.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <memory>
#include <mutex>

#include "daemon/simulation/pose_service/pose_run.h"
#include "daemon/simulation/serving/simulation_thread.h"
#include "tests/simulation/reconstruction/made_person.h"
#include "tests/simulation/serving/counted_calls.h"

namespace footing::pose_service {
namespace {

namespace made = reconstruction;

struct Person {
  body::Body body = made::MadePerson();
  motion::Motion motion = made::MadeMotion(body, 8);
  std::vector<made::Inputs> measured = made::Measured(body, motion);
  made::Models models = made::MakeModels({made::BasisOf(body, motion)}).value();

  std::unique_ptr<SubjectRun> Run(std::uint64_t number) const {
    made::Options options;
    options.rate_hz = made::kMadeRateHz;
    return std::make_unique<SubjectRun>(
        SubjectRun{number, made::Reconstruction::Create(body, models, options).value(),
                   made::InsoleWalk::Create(body, models, options).value()});
  }
};

TEST(PoseThread, AllocatesFreesLocksAndSoLogsNothingOnceItRunsThroughTPoseMotionAndNextSubject) {
#ifndef FOOTING_COUNTS_CALLS
  GTEST_SKIP() << "the sanitizer owns malloc and mutexes";
#else
  using counted_calls::allocations;
  using counted_calls::locks;
  counted_calls::is_test_thread = true;
  const Person person;
  SubjectExchange subjects;
  const int wake = eventfd(0, EFD_CLOEXEC);
  ASSERT_GE(wake, 0);
  // A step of a millisecond: seventeen times faster than the person moves.
  serving::SimulationThread<PoseRun> thread(PoseRun(person.Run(0), made::kMadeRateHz, subjects),
                                            1e-3, 1, wake);
  thread.Start();
  PoseFrame frame;
  const auto next_frame = [&] {
    while (!thread.frames().Pop(frame)) {
      pollfd ready{wake, POLLIN, 0};
      if (poll(&ready, 1, 5000) <= 0) return false;
      std::uint64_t count = 0;
      if (read(wake, &count, sizeof(count)) < 0) return false;
    }
    return true;
  };
  ASSERT_TRUE(next_frame());
  const long allocations_start = allocations, locks_start = locks;
  PoseInputs told;
  bool calibrated = false, calibrated_again = false;
  for (std::size_t i = 0; i < 2 * person.measured.size(); ++i) {
    told.sensors = person.measured[i % person.measured.size()];
    if (i == person.measured.size()) {
      ASSERT_TRUE(subjects.next.Push(person.Run(1)));
      told.subject_number = 1;
    }
    if (i == 450) ++told.calibrate_number;
    for (auto& insole : told.insoles) {  // Worn while the first one moves.
      insole.valid = i > 400 && i < 440;
      insole.count = 1;
      insole.load_n[0] = 343;
    }
    thread.inputs().Write(told);
    ASSERT_TRUE(next_frame());
    calibrated |= frame.t_pose.complete && frame.subject_number == 0;
    calibrated_again |= frame.t_pose.complete && frame.subject_number == 1;
  }
  EXPECT_TRUE(calibrated);
  EXPECT_TRUE(calibrated_again);
  EXPECT_EQ(allocations, allocations_start);
  EXPECT_EQ(locks, locks_start);
  // The counters do count: another thread that takes both.
  std::thread other([] {
    static std::mutex mutex;
    const std::lock_guard<std::mutex> guard(mutex);
    const auto probe = std::make_unique<std::vector<int> >(100);
    ASSERT_NE(probe, nullptr);
  });
  other.join();
  EXPECT_GT(allocations, allocations_start);
  EXPECT_GT(locks, locks_start);
  thread.Stop();
  close(wake);
#endif
}

}  // namespace
}  // namespace footing::pose_service
