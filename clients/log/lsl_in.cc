#include "clients/log/lsl_in.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/write.hpp>

#include "clients/log/lsl.h"
#include "clients/log/lsl_outlets.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/net/address.h"
#include "common/net/own_address.h"
#include "common/net/socket.h"
#include "common/runtime/clock.h"
#include "common/runtime/timer.h"
#include "footing/v1/lsl.pb.h"

namespace footing::log_client::lsl {
namespace asio = boost::asio;
using asio::ip::tcp;
using asio::ip::udp;
using boost::system::error_code;

namespace {

constexpr auto kAskPeriod = std::chrono::milliseconds(1000);
constexpr auto kAnswerWithin = std::chrono::seconds(5);
/// As liblsl measures clocks: of eight exchanges that with the shortest round trip, every 5 s.
constexpr int kProbes = 8;
constexpr auto kProbePeriod = std::chrono::milliseconds(64);
constexpr auto kClockPeriod = std::chrono::seconds(5);
/// Before a stream that has ended or makes no sense is asked again.
constexpr double kPauseS = 2;
constexpr std::size_t kMostNameBytes = 100;

std::string TopicName(const std::string& name) {
  std::string topic;
  for (const char c : name.substr(0, kMostNameBytes)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '.' || c == '_';
    topic += plain ? c : '_';
  }
  return topic;
}

}  // namespace

/// The part that all streams of a recording share.
struct Shared {
  asio::io_context& io;
  recording::RecordingWriter& writer;
  std::function<void(Result<void>)> on_written;
  std::uint64_t samples = 0;
  std::set<std::string> begun = {};  ///< Topics with samples.
};

/// One connection to a stream: its description, then its feed, and its clock beside it.
class Inlet : public std::enable_shared_from_this<Inlet> {
 public:
  Inlet(Shared& shared, Info info, std::string topic, const asio::ip::address& address)
      : shared_(shared),
        info_(std::move(info)),
        topic_(std::move(topic)),
        address_(address),
        socket_(shared.io),
        clock_(shared.io),
        deadline_(shared.io),
        probe_(shared.io) {}

  void Start() {
    error_code error;
    clock_.open(udp::v4(), error);
    if (!error) clock_.connect({address_, info_.service_port}, error);
    if (!error) clock_.non_blocking(true, error);
    if (error) return End("its clock cannot be asked: " + transport::MessageOf(error));
    ReceiveTimes();
    Probe(0);
    Connect("LSL:fullinfo\r\n", &Inlet::ReadInfo);
  }

  void Stop() {
    ended_ = true;
    ended_s_ = NowS();
    deadline_.cancel();
    probe_.cancel();
    error_code ignored;  // They are not used any more.
    socket_.close(ignored);
    clock_.close(ignored);
  }

  bool MayBeTriedAgain() const { return ended_ && NowS() - ended_s_ > kPauseS; }

 private:
  void End(const std::string& why) {
    if (ended_) return;
    std::cerr << "LSL stream " << text::Quoted(info_.name) << ": " << why << std::endl;
    Stop();
  }

  void Connect(std::string request, void (Inlet::*then)()) {
    error_code ignored;  // A new socket is opened anyway.
    socket_.close(ignored);
    request_ = std::move(request);
    bytes_.clear();
    deadline_.After(kAnswerWithin, [this] { End("it does not answer"); });
    socket_.async_connect({address_, info_.data_port},
                          [self = shared_from_this(), then](const error_code& error) {
                            if (self->ended_) return;
                            if (error)
                              return self->End("cannot connect: " + transport::MessageOf(error));
                            asio::async_write(self->socket_, asio::buffer(self->request_),
                                              [self, then](const error_code& failed, std::size_t) {
                                                if (self->ended_) return;
                                                if (failed)
                                                  return self->End(transport::MessageOf(failed));
                                                (*self.*then)();
                                              });
                          });
  }

  /// The description ends with the connection.
  void ReadInfo() {
    socket_.async_read_some(asio::buffer(buffer_), [self = shared_from_this()](
                                                       const error_code& error, std::size_t count) {
      if (self->ended_) return;
      self->bytes_.append(self->buffer_.data(), count);
      if (self->bytes_.size() > kMostInfoBytes) return self->End("its description is too long");
      // liblsl sends no end of it before the client closes.
      if (!error && self->bytes_.find("</info>") == std::string::npos) return self->ReadInfo();
      self->OnInfo();
    });
  }

  void OnInfo() {
    auto info = ParseInfo(bytes_);
    if (!info) return End(info.error().message);
    if (info->uid != info_.uid || info->channels != info_.channels || info->format != info_.format)
      return End("its description is one of another stream");
    info->v4address = address_.to_string();
    info->data_port = info_.data_port;
    info->service_port = info_.service_port;
    info_ = std::move(*info);
    auto written = shared_.writer.Flush();
    if (written) {
      written = shared_.writer.AddMetadata(kStreamMetadata,
                                           {{"topic", topic_}, {"info", FullInfo(info_)}});
    }
    shared_.on_written(std::move(written));
    described_ = true;
    FeedOnceReady();
  }

  /// Samples come once the clock has been measured, or has not answered, so that each has its time
  /// on our clock.
  void FeedOnceReady() {
    if (!described_ || !times_of_.was_asked || feed_) return;
    feed_.emplace(info_);
    Connect(FeedRequest(info_), &Inlet::ReadFeed);
  }

  void ReadFeed() {
    socket_.async_read_some(asio::buffer(buffer_), [self = shared_from_this()](
                                                       const error_code& error, std::size_t count) {
      if (self->ended_) return;
      if (error) return self->End("it has ended");
      self->deadline_.cancel();
      std::vector<Sample> samples;
      const auto taken = self->feed_->Take({self->buffer_.data(), count}, samples);
      self->Write(samples);
      if (!taken) return self->End(taken.error().message);
      if (!self->ended_) self->ReadFeed();
    });
  }

  void Write(const std::vector<Sample>& samples) {
    if (samples.empty()) return;
    v1::LslSamples message;
    for (const Sample& sample : samples) {
      v1::LslSample& one = *message.add_samples();
      const double period_s = info_.nominal_hz > 0 ? 1 / info_.nominal_hz : 0;
      last_s_ = sample.time_s.value_or(last_s_ + period_s);
      one.set_time_s(last_s_);
      one.set_host_ns(
          static_cast<std::int64_t>(1e9 * (last_s_ + times_of_.correction_s.value_or(0))));
      one.mutable_values()->Add(sample.values.begin(), sample.values.end());
      for (const std::string& text : sample.texts) one.add_texts(text);
    }
    shared_.samples += samples.size();
    shared_.begun.insert(topic_);
    WriteMessage(topic_, message);
  }

  void WriteMessage(const std::string& topic, const google::protobuf::Message& message) {
    const std::int64_t now_ns = clock::MonotonicNs();
    shared_.on_written(shared_.writer.Write(topic, message, {now_ns, now_ns, 0}));
  }

  void ReceiveTimes() {
    clock_.async_receive(asio::buffer(times_), [self = shared_from_this()](const error_code& error,
                                                                           std::size_t count) {
      const double arrived_s = NowS();
      if (self->ended_) return;
      auto exchange = error ? std::nullopt : ParseTimeAnswer({self->times_.data(), count});
      if (exchange && exchange->wave == self->times_of_.wave &&
          exchange->t0 == self->times_of_.asked_s) {
        exchange->t3 = arrived_s;
        const bool possible = exchange->round_trip_s() >= 0 && exchange->t2 >= exchange->t1;
        if (possible && (!self->times_of_.best ||
                         exchange->round_trip_s() < self->times_of_.best->round_trip_s()))
          self->times_of_.best = *exchange;
      }
      self->ReceiveTimes();
    });
  }

  /// One exchange after the other; at the last the best of them counts.
  void Probe(int number) {
    if (number == kProbes) {
      if (times_of_.best) TakeClock(*times_of_.best);
      times_of_.best.reset();
      ++times_of_.wave;
      times_of_.was_asked = true;
      FeedOnceReady();
      return probe_.After(kClockPeriod, [this] { Probe(0); });
    }
    times_of_.asked_s = NowS();
    const std::string request = EncodeTimeRequest({times_of_.wave, times_of_.asked_s, 0, 0, 0});
    // The echo is compared with the text that was sent, whose time is rounded.
    times_of_.asked_s = ParseTimeRequest(request)->t0;
    error_code ignored;  // It is asked again.
    clock_.send(asio::buffer(request), 0, ignored);
    probe_.After(number == 0 || times_of_.best ? kProbePeriod / 8 : kProbePeriod,
                 [this, number] { Probe(number + 1); });
  }

  void TakeClock(const TimeExchange& exchange) {
    times_of_.correction_s = exchange.correction_s();
    v1::LslClock message;
    message.set_time_s((exchange.t1 + exchange.t2) / 2);
    message.set_correction_s(*times_of_.correction_s);
    message.set_uncertainty_s(exchange.round_trip_s() / 2);
    WriteMessage(topic_ + "/clock", message);
  }

  Shared& shared_;
  Info info_;
  std::string topic_;
  asio::ip::address address_;
  tcp::socket socket_;
  udp::socket clock_;
  timer::Timer deadline_, probe_;
  std::string request_, bytes_;
  std::array<char, 1 << 16> buffer_{};
  std::array<char, 512> times_{};
  std::optional<FeedReader> feed_;
  double last_s_ = 0;
  /// One series of exchanges, and what the series so far have said.
  struct Clock {
    std::int32_t wave = 1;
    double asked_s = 0;
    std::optional<TimeExchange> best;
    std::optional<double> correction_s;
    bool was_asked = false;
  } times_of_;
  bool described_ = false;
  bool ended_ = false;
  double ended_s_ = 0;
};

class StreamsRecorder::Implementation
    : public std::enable_shared_from_this<StreamsRecorder::Implementation> {
 public:
  Implementation(asio::io_context& io, recording::RecordingWriter& writer,
                 std::vector<std::string> queries, std::function<void(Result<void>)> on_written)
      : shared_{io, writer, std::move(on_written)},
        queries_(std::move(queries)),
        socket_(io),
        ask_(io) {}

  Result<void> Start() {
    error_code error;
    socket_.open(udp::v4(), error);
    if (!error) socket_.bind(udp::endpoint(udp::v4(), 0), error);
    if (!error) socket_.set_option(asio::socket_base::broadcast(true), error);
    if (!error) socket_.set_option(asio::ip::multicast::hops(1), error);
    if (!error) socket_.non_blocking(true, error);
    if (error) return Failure("cannot look for LSL streams: " + transport::MessageOf(error));
    Receive();
    Ask();
    return {};
  }

  void Stop() {
    stopped_ = true;
    ask_.cancel();
    error_code ignored;  // It is not used any more.
    socket_.close(ignored);
    for (const auto& [uid, inlet] : inlets_) inlet->Stop();
  }

  const Shared& shared() const { return shared_; }
  const std::vector<std::string>& queries() const { return queries_; }

 private:
  void Ask() {
    std::erase_if(inlets_, [](const auto& entry) { return entry.second->MayBeTriedAgain(); });
    for (std::size_t i = 0; i < queries_.size(); ++i) {
      ShortInfoRequest request{queries_[i], socket_.local_endpoint().port(), std::to_string(i)};
      const std::string text = Encode(request);
      SendTo("127.0.0.1", text);
      SendTo("255.255.255.255", text);
      for (const std::string& interface : transport::OwnAddresses()) {
        error_code ignored;  // It may be down by now.
        socket_.set_option(
            asio::ip::multicast::outbound_interface(asio::ip::make_address_v4(interface)), ignored);
        for (const char* group : kGroups) SendTo(group, text);
      }
    }
    ask_.After(kAskPeriod, [this] { Ask(); });
  }

  void SendTo(const char* address, const std::string& text) {
    error_code ignored;  // Without a network some of them cannot be reached.
    socket_.send_to(asio::buffer(text), {asio::ip::make_address(address), kQueryPort}, 0, ignored);
  }

  void Receive() {
    socket_.async_receive_from(
        asio::buffer(answer_), from_,
        [self = shared_from_this()](const error_code& error, std::size_t count) {
          if (self->stopped_) return;
          if (!error) self->Take({self->answer_.data(), count});
          self->Receive();
        });
  }

  void Take(std::string_view answer) {
    const std::size_t end = answer.find("\r\n");
    if (end == std::string_view::npos) return;
    const auto number = text::ToCount(answer.substr(0, end));
    if (!number || *number >= queries_.size()) return;
    const auto info = ParseInfo(answer.substr(end + 2));
    if (!info || info->name.empty()) return;
    if (!Matches(*info, queries_[*number]) || inlets_.contains(info->uid)) return;
    if (inlets_.size() >= kMostStreams) {
      if (!std::exchange(full_, true))
        std::cerr << "LSL: no more than 64 streams are recorded" << std::endl;
      return;
    }
    // Whatever the answer says: nobody but its sender is to be asked for the data.
    const asio::ip::address address = from_.address();
    const auto inlet = std::make_shared<Inlet>(shared_, *info, TopicOf(*info), address);
    inlets_[info->uid] = inlet;
    std::cerr << "LSL stream " << text::Quoted(info->name) << " of " << address.to_string()
              << ": recording" << std::endl;
    inlet->Start();
  }

  /// The same for a stream that comes back; two of one name have two topics.
  std::string TopicOf(const Info& info) {
    const auto key = std::pair(info.name, info.source_id.empty() ? info.uid : info.source_id);
    if (const auto known = topics_.find(key); known != topics_.end()) return known->second;
    std::string topic = "/lsl/" + TopicName(info.name);
    if (!names_.insert(topic).second) topic += "_" + std::to_string(topics_.size() + 1);
    names_.insert(topic);
    return topics_[key] = topic;
  }

  Shared shared_;
  std::vector<std::string> queries_;
  udp::socket socket_;
  timer::Timer ask_;
  std::array<char, 1 << 16> answer_{};
  udp::endpoint from_;
  std::map<std::string, std::shared_ptr<Inlet>> inlets_;  ///< By uid.
  std::map<std::pair<std::string, std::string>, std::string> topics_;
  std::set<std::string> names_;
  bool full_ = false;
  bool stopped_ = false;
};

StreamsRecorder::StreamsRecorder(asio::io_context& io, recording::RecordingWriter& writer,
                                 std::vector<std::string> queries,
                                 std::function<void(Result<void>)> on_written)
    : implementation_(std::make_shared<Implementation>(io, writer, std::move(queries),
                                                       std::move(on_written))) {}
StreamsRecorder::~StreamsRecorder() { Stop(); }

Result<void> StreamsRecorder::Start() { return implementation_->Start(); }
void StreamsRecorder::Stop() { implementation_->Stop(); }
std::size_t StreamsRecorder::streams() const { return implementation_->shared().begun.size(); }
std::uint64_t StreamsRecorder::samples() const { return implementation_->shared().samples; }
std::string StreamsRecorder::Waited() const {
  return "LSL streams of " + text::Joined(implementation_->queries(), " or ");
}

}  // namespace footing::log_client::lsl
