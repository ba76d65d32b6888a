#include "clients/camera/measure_lens.h"

#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <utility>

#include "common/camera/view_collector.h"
#include "common/runtime/log.h"

namespace footing::camera {
namespace {

class LensMeasurement {
 public:
  explicit LensMeasurement(const LensOptions& options)
      : options_(options),
        signals_(io_, SIGINT, SIGTERM),
        limit_(io_),
        collector_(options.views, options.frames.folder.empty()) {}

  Result<LensReport> Run() {
    auto source = OpenFrames(io_, options_.frames, options_.camera,
                             [](const std::string& line) { log::Warning(line); });
    if (!source) return source.error();
    source_ = std::move(source).value();
    signals_.async_wait([this](boost::system::error_code error, int) {
      if (!error) End(Failure("stopped"));
    });
    limit_.expires_after(std::chrono::milliseconds(std::llround(1e3 * options_.seconds)));
    limit_.async_wait([this](boost::system::error_code error) {
      if (!error) End({});
    });
    source_->Start([this](const frames::Frame& frame, std::int64_t) { Take(frame); },
                   [this](Result<void> end) { End(std::move(end)); });
    io_.run();
    if (!end_) return end_.error();
    const sphere::Lens& lens = options_.camera.lens;
    const auto fit = lens_calibration::FitLens(collector_.views(), lens.width, lens.height);
    if (!fit) return fit.error();
    return LensReport{*fit, frames_, collector_.views().size()};
  }

 private:
  void Take(const frames::Frame& frame) {
    if (ended_) return;
    if (const auto checked = CheckSize(frame, options_.camera); !checked)
      return End(checked.error());
    ++frames_;
    collector_.Take(frame.View());
    if (collector_.is_complete()) return End({});
    if (const std::string advice = collector_.Advice(); advice != advice_) {
      log::Info(advice);
      advice_ = advice;
    }
  }

  void End(Result<void> end) {
    if (std::exchange(ended_, true)) return;
    end_ = std::move(end);
    source_->Stop();
    signals_.cancel();
    limit_.cancel();
  }

  const LensOptions& options_;
  boost::asio::io_context io_{1};
  boost::asio::signal_set signals_;
  boost::asio::steady_timer limit_;
  std::unique_ptr<Source> source_;
  lens_calibration::ViewCollector collector_;
  std::size_t frames_ = 0;
  std::string advice_;
  Result<void> end_;
  bool ended_ = false;
};

}  // namespace

Result<LensReport> MeasureLens(const LensOptions& options) {
  return LensMeasurement(options).Run();
}

}  // namespace footing::camera
