#include "clients/view/app/text_view.h"

#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <iostream>

#include "clients/view/app/feed.h"
#include "clients/view/app/preview_link.h"
#include "clients/view/app/summary.h"
#include "clients/view/scene/show.h"
#include "clients/view/scene/words.h"
#include "common/runtime/clock.h"
#include "common/net/run_folder.h"
#include "common/base/units.h"

namespace footing::view {
namespace {

constexpr const char* kHomeAndClear = "\x1b[H\x1b[J";

/// Everything on one thread: a tick counts as seen when its handler runs.
class TextView {
 public:
  explicit TextView(const Options& options)
      : options_(options),
        started_ns_(clock::MonotonicNs()),
        screen_(WantsScreen(options)),
        timer_(io_),
        signals_(io_, SIGINT, SIGTERM),
        feed_(io_, options,
              {[this](const scene::Update& update) { show_.Take(update, clock::MonotonicNs()); },
               [this](int source, const scene::LinkReport& report) {
                 show_.model().links[static_cast<std::size_t>(source)] = report;
               }}),
        preview_(io_, options.camera.address, [this](const scene::CameraPreview& preview) {
          show_.model().observed.camera = preview;
        }) {
    show_.model().links = Feed::InitialReports(options);
  }

  Result<void> Run() {
    signals_.async_wait([this](const boost::system::error_code& error, int) {
      if (!error) Stop();
    });
    feed_.Start();
    if (options_.camera.corner || options_.camera.alone) preview_.Start();
    WaitToDraw();
    io_.run();
    if (options_.json) std::cout << Summary(show_.model(), PassedS()) << std::endl;
    return WhyNothing();
  }

 private:
  /// Why nothing was seen: a server could be reached but did not let this viewer in, or none was
  /// there in the whole time that the viewer was given.
  Result<void> WhyNothing() {
    const scene::LinkReport* refused = nullptr;
    std::string waited_for;
    for (const scene::LinkReport& link : show_.model().links) {
      if (!link.server_id.empty()) return {};  // Another server was there.
      if (link.state == scene::LinkState::kRefused) refused = &link;
      waited_for += (waited_for.empty() ? "" : "; ") +
                    (link.why.empty() ? link.address + " does not answer" : link.why);
    }
    if (refused != nullptr) return Failure(refused->why);
    if (!time_is_up_ || options_.camera.alone) return {};
    return NoDevice("no server: " + waited_for +
                    transport::RemedyFor(
                        waited_for, "start footing-sim, or name where it listens with --connect"));
  }

  double PassedS() const { return NanosecondsToSeconds(clock::MonotonicNs() - started_ns_); }

  void WaitToDraw() {
    double wait_s = screen_ ? kScreenEveryS : kLineEveryS;
    if (options_.seconds > 0) wait_s = std::min(wait_s, options_.seconds - PassedS());
    timer_.expires_after(std::chrono::nanoseconds(SecondsToNanoseconds(std::max(wait_s, 0.0))));
    timer_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      Draw();
      time_is_up_ = options_.seconds > 0 && PassedS() >= options_.seconds;
      if (time_is_up_) return Stop();
      WaitToDraw();
    });
  }

  void Draw() {
    ++show_.model().tally.frames_drawn;
    const std::int64_t now_ns = clock::MonotonicNs();
    if (options_.camera.alone) return DrawCamera(now_ns);
    if (!screen_) {
      // With --json standard output is for the summary alone.
      std::ostream& out = options_.json ? std::cerr : std::cout;
      out << scene::StatusLine(show_.model(), now_ns) << std::endl;
      return;
    }
    std::cout << ScreenText(scene::StatusScreen(show_.model(), now_ns)) << std::endl;
  }

  void DrawCamera(std::int64_t now_ns) {
    std::ostream& out = options_.json ? std::cerr : std::cout;
    std::vector<std::string> lines;
    scene::AddPreviewLines(show_.model().observed.camera, now_ns, lines);
    out << (screen_ ? ScreenText(lines)
                    : scene::PreviewStatus(show_.model().observed.camera, now_ns))
        << std::endl;
  }

  void Stop() {
    feed_.Stop();
    io_.stop();
  }

  const Options& options_;
  std::int64_t started_ns_;
  bool screen_;
  bool time_is_up_ = false;
  boost::asio::io_context io_;
  boost::asio::steady_timer timer_;
  boost::asio::signal_set signals_;
  scene::Show show_;
  Feed feed_;
  PreviewLink preview_;
};

}  // namespace

bool WantsScreen(const Options& options) { return !options.json && isatty(STDOUT_FILENO) == 1; }

std::string ScreenText(const std::vector<std::string>& lines) {
  std::string text = kHomeAndClear;
  for (const std::string& line : lines) text += line + "\n";
  return text + "Ctrl-C leaves.";
}

Result<void> RunTextView(const Options& options) { return TextView(options).Run(); }

}  // namespace footing::view
