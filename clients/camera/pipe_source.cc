#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <cerrno>
#include <cstring>

#include "clients/camera/source.h"
#include "common/runtime/clock.h"
#include "common/frames/netpbm.h"

namespace footing::camera {
namespace {

class PipeSource : public Source {
 public:
  PipeSource(boost::asio::io_context& io, int descriptor, const PipeSettings& settings)
      : pipe_(io, descriptor),
        latency_ns_(static_cast<std::int64_t>(1e9 * settings.latency_s)),
        stamped_(settings.stamped) {}

  void Start(OnFrame on_frame, OnEnd on_end) override {
    on_frame_ = std::move(on_frame);
    on_end_ = std::move(on_end);
    Read();
  }

  void Stop() override {
    boost::system::error_code ignored;
    pipe_.close(ignored);
  }

 private:
  void Read() {
    pipe_.async_read_some(boost::asio::buffer(buffer_),
                          [this](boost::system::error_code error, std::size_t count) {
                            if (error == boost::asio::error::operation_aborted) return;
                            if (error == boost::asio::error::eof) return AtEnd();
                            if (error) return on_end_(Failure("frames: " + error.message()));
                            Take(count);
                          });
  }

  void AtEnd() {
    if (reader_.empty()) return on_end_({});
    on_end_(InvalidData("frames: the last image is cut off"));
  }

  void Take(std::size_t count) {
    reader_.Add({buffer_.data(), count});
    const std::int64_t exposed_ns = clock::MonotonicNs() - latency_ns_;
    while (true) {
      const auto frame = reader_.Next();
      if (!frame) return on_end_(frame.error());
      if (!*frame) break;
      const auto& time_ns = (*frame)->time_ns;
      if (stamped_ && !time_ns)
        return on_end_(InvalidData("frames: an image has no comment with its time (# time_ns N)"));
      on_frame_(**frame, stamped_ ? *time_ns : exposed_ns);
    }
    if (pipe_.is_open()) Read();
  }

  boost::asio::posix::stream_descriptor pipe_;
  const std::int64_t latency_ns_;
  const bool stamped_;
  OnFrame on_frame_;
  OnEnd on_end_;
  frames::NetpbmReader reader_;
  std::array<char, 1 << 16> buffer_;
};

}  // namespace

Result<std::unique_ptr<Source>> OpenPipe(boost::asio::io_context& io, const std::string& path,
                                         const PipeSettings& settings) {
  // Blocks until a writer opens the FIFO; without a writer, a read would return end of file at
  // once.
  const int descriptor = path == "-" ? ::dup(STDIN_FILENO) : ::open(path.c_str(), O_RDONLY);
  if (descriptor < 0)
    return Failure("cannot open " + path + ": " + std::string(std::strerror(errno)));
  try {
    return std::unique_ptr<Source>(std::make_unique<PipeSource>(io, descriptor, settings));
  } catch (const boost::system::system_error& error) {
    ::close(descriptor);
    return Failure(path + " is not a FIFO: " + error.code().message() +
                   "; frames of a folder come with --frames");
  }
}

}  // namespace footing::camera
