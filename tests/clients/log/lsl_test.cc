#include "clients/log/lsl.h"

#include <chrono>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/write.hpp>

#include "clients/log/lsl_out.h"
#include "clients/log/lsl_outlets.h"

namespace footing::log_client::lsl {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string Hex(std::string_view bytes) {
  std::string hex;
  for (const char c : bytes) {
    constexpr char kDigits[] = "0123456789abcdef";
    hex += kDigits[static_cast<unsigned char>(c) >> 4];
    hex += kDigits[static_cast<unsigned char>(c) & 15];
  }
  return hex;
}

Info Board() {
  Info info;
  info.name = "footingd/boards/left_board";
  info.type = "Force";
  info.source_id = "footingd/boards/left_board/00:1f <a&b>";
  info.channels = 2;
  info.nominal_hz = 0;
  info.created_s = 1234.5;
  info.uid = "a-uid";
  info.hostname = "lab";
  info.v4address = "127.0.0.1";
  info.data_port = 16572;
  info.service_port = 16573;
  info.description = Describe({{"cop_x_m", "m"}, {"moving", ""}}, "Force", {{"rig", "main"}});
  return info;
}

// struct.pack("<Bddd", 2, 123456.789, k + offset + 16777217, ...) for the offsets 4 and 2.
TEST(LslBytes, TestSamplesAreThoseOfTheProtocol) {
  EXPECT_EQ(Hex(TestSamples(Format::kDouble64, 2)),
            "02c976be9f0c24fe40000000500000704100000060000070c1"
            "02c976be9f0c24fe40000000300000704100000040000070c1");
  // Integers of few bits wrap at the largest one: 16 bits are (k + 4 + 257) modulo 32767.
  EXPECT_EQ(Hex(TestSamples(Format::kInt16, 2)).substr(18, 8), "0501fafe");
  EXPECT_EQ(Hex(TestSamples(Format::kInt8, 2)).substr(18, 4), "05fa");
  EXPECT_EQ(Hex(TestSamples(Format::kFloat32, 1)).substr(18, 8), "00008040");
  EXPECT_EQ(Hex(TestSamples(Format::kInt32, 1)).substr(18, 8), "05000100");
  EXPECT_EQ(Hex(TestSamples(Format::kInt64, 1)).substr(18, 16), "0500008000000000");
  EXPECT_EQ(Hex(TestSamples(Format::kString, 2)).substr(18, 18), "0102313001032d3131");
}

TEST(LslBytes, SamplesHaveATagATimeAndTheirValues) {
  std::string numbers, text;
  AppendSample(12.5, std::vector<double>{-9.81, 0.25}, numbers);
  AppendSample(12.5, "walk", text);
  EXPECT_EQ(Hex(numbers), "0200000000000029401f85eb51b89e23c0000000000000d03f");
  EXPECT_EQ(Hex(text), "020000000000002940010477616c6b");
  std::string longer;
  AppendSample(12.5, std::string(300, 'x'), longer);
  EXPECT_EQ(Hex(longer.substr(9, 5)), "042c010000");
}

TEST(LslBytes, AnInfoIsReadBackAsItWas) {
  const auto read = ParseInfo(FullInfo(Board()));
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->source_id, Board().source_id);
  EXPECT_EQ(read->description, Board().description);
  EXPECT_EQ(FullInfo(*read), FullInfo(Board()));
  EXPECT_THAT(FullInfo(Board()),
              HasSubstr("<rig>main</rig><channels><channel><label>cop_x_m</label>"
                        "<unit>m</unit><type>Force</type></channel>"));
  EXPECT_THAT(ShortInfo(Board()), HasSubstr("<desc></desc>"));
}

// As a liblsl of another host writes it.
constexpr char kForeign[] =
    "<?xml version=\"1.0\"?>\n<info>\n\t<name>Bio &amp; Semi</name>\n\t<type>EEG</type>\n"
    "\t<channel_count>8</channel_count>\n\t<channel_format>float32</channel_format>\n"
    "\t<source_id />\n\t<nominal_srate>100.0000000000000</nominal_srate>\n"
    "\t<version>1.100000000000000</version>\n\t<created_at>50942.72331941300</created_at>\n"
    "\t<uid>1</uid>\n\t<session_id>default</session_id>\n\t<hostname>eeg</hostname>\n"
    "\t<v4address "
    "/>\n\t<v4data_port>16574</v4data_port>\n\t<v4service_port>16575</v4service_port>\n"
    "\t<v6address />\n\t<v6data_port>0</v6data_port>\n\t<v6service_port>0</v6service_port>\n"
    "\t<desc />\n</info>\n";

TEST(LslBytes, InfosThatMakeNoSenseAreRefused) {
  const std::string good = kForeign;
  ASSERT_TRUE(ParseInfo(good).ok()) << ParseInfo(good).error().message;
  EXPECT_EQ(ParseInfo(good)->name, "Bio & Semi");
  EXPECT_EQ(ParseInfo(good)->nominal_hz, 100);
  const auto with = [&](const std::string& what, const std::string& by) {
    std::string changed = good;
    changed.replace(changed.find(what), what.size(), by);
    return ParseInfo(changed).ok();
  };
  EXPECT_FALSE(with("<channel_count>8", "<channel_count>999999999"));
  EXPECT_FALSE(with("<channel_count>8", "<channel_count>-8"));
  EXPECT_FALSE(with("float32", "float16"));
  EXPECT_FALSE(with("16574", "99999"));
  EXPECT_FALSE(with("<uid>1<", "<uid><"));
  EXPECT_FALSE(with("1.100000000000000", "1.000000000000000"));
  EXPECT_FALSE(with("100.0000000000000", "nan"));
  for (std::size_t size = 0; size + 9 < good.size(); size += 7)
    EXPECT_FALSE(ParseInfo(good.substr(0, size)).ok()) << size;
}

TEST(LslBytes, QueriesMatchAsInXPath) {
  const Info info = Board();
  for (const char* query :
       {"", "name='footingd/boards/left_board'", "session_id='default' and type='Force'",
        "starts-with(name,'footingd') and contains( source_id , 'left_board' )",
        "type=\"EEG\" or type=\"Force\"", "not(type='EEG')",
        "channel_count > 1 and v4data_port<=16572",
        "(type='EEG' or type='Force') and not(name='x')", "nominal_srate=0", "hostname!='x'",
        "source_id", "channel_count='2'"}) {
    EXPECT_TRUE(Matches(info, query)) << query;
  }
  for (const char* query : {"type='EEG'", "nothing='x'", "nothing!='x'", "nothing",
                            "name='footingd/boards/left_board' and type='EEG'", "desc/channels",
                            "name=", "name='open", "name='x' and", "f(name)", "((((",
                            "contains(name)", "name='x' name='y'", "count(//*[//*[//*]]) > 0"}) {
    EXPECT_FALSE(Matches(info, query)) << query;
  }
  EXPECT_FALSE(Matches(info, std::string(10'000, '(')));
  EXPECT_TRUE(CheckQuery("name='x' and type='y'").ok());
  EXPECT_THAT(CheckQuery("desc/x='1'").error().message, HasSubstr("such as: name='BioSemi'"));
}

TEST(LslBytes, DatagramsAreTakenOnlyWhole) {
  const auto request = ParseShortInfoRequest("LSL:shortinfo\r\ntype='EEG'\r\n16600 4711\r\n");
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(request->query, "type='EEG'");
  EXPECT_EQ(request->return_port, 16600);
  EXPECT_EQ(Encode(*request), "LSL:shortinfo\r\ntype='EEG'\r\n16600 4711\r\n");
  EXPECT_EQ(ShortInfoAnswer(request->query_id, Board()).substr(0, 6), "4711\r\n");
  for (const char* bad : {"", "LSL:shortinfo", "LSL:shortinfo\r\n\r\n99999 1\r\n", "\xff\xfe",
                          "LSL:shortinfo\r\nx\r\n0 1\r\n", "LSL:shortinfo\r\nx\r\n16600\r\n"}) {
    EXPECT_FALSE(ParseShortInfoRequest(bad).has_value()) << bad;
  }
  const auto asked = ParseTimeRequest("LSL:timedata\r\n7 50942.72331941297\r\n");
  ASSERT_TRUE(asked.has_value());
  EXPECT_EQ(EncodeTimeAnswer({asked->wave, asked->t0, 60000.25, 60000.5}),
            " 7 50942.72331941297 60000.25 60000.5");
  EXPECT_EQ(EncodeTimeRequest(*asked), "LSL:timedata\r\n7 50942.72331941297\r\n");
  EXPECT_FALSE(ParseTimeRequest("LSL:timedata\r\n7 nan\r\n").has_value());
  // The other clock is 100 s ahead and each way takes 1 ms: 100 s have to be taken off.
  auto exchange = *ParseTimeAnswer(" 7 10 110.001 110.003");
  exchange.t3 = 10.004;
  EXPECT_NEAR(exchange.correction_s(), -100, 1e-9);
  EXPECT_NEAR(exchange.round_trip_s(), 0.002, 1e-9);
}

TEST(LslBytes, RequestsOfAnythingElseAreRefused) {
  const Info info = Board();
  const auto kind = [&](const std::string& bytes) { return ParseRequest(bytes, info).kind; };
  using Kind = Request::Kind;
  EXPECT_EQ(kind("LSL:fullinfo\r\n"), Kind::kFullInfo);
  EXPECT_EQ(kind("LSL:shortinfo\r\ntype='Force'\r\n"), Kind::kShortInfo);
  EXPECT_EQ(kind("LSL:streamfeed/110 a-uid\r\nValue-Size: 8\r\n"), Kind::kIncomplete);
  EXPECT_EQ(kind(FeedRequest(info)), Kind::kStreamFeed);
  EXPECT_EQ(kind("LSL:streamfeed/110 \r\n\r\n"), Kind::kStreamFeed);
  const auto refusal = [&](const std::string& bytes) { return ParseRequest(bytes, info).refusal; };
  EXPECT_THAT(refusal("LSL:streamfeed/110 other\r\n\r\n"), HasSubstr("LSL/110 404 Not found"));
  EXPECT_THAT(refusal("LSL:streamfeed\r\n"), HasSubstr("505"));
  EXPECT_THAT(refusal("LSL:streamfeed/210 a-uid\r\n"), HasSubstr("505"));
  EXPECT_THAT(refusal("LSL:streamfeed/x a-uid\r\n"), HasSubstr("400"));
  EXPECT_THAT(refusal("LSL:streamfeed/110 a-uid\r\nValue-Size: 4\r\n\r\n"), HasSubstr("415"));
  EXPECT_THAT(refusal("GET / HTTP/1.1\r\n"), HasSubstr("400 Bad request"));
  EXPECT_THAT(refusal("LSL:shortinfo\r\ntype='EEG'\r\n"), HasSubstr("404"));
  EXPECT_THAT(refusal(std::string(kMostRequestBytes, 'x')), HasSubstr("413"));
}

TEST(LslBytes, AFeedIsReadHoweverItIsCut) {
  const Info info = Board();
  std::string feed = FeedStart(info);
  AppendSample(1.5, std::vector<double>{1, 2}, feed);
  feed += '\1';
  feed += feed.substr(feed.size() - 17, 16);  // The same values, a period later.
  FeedReader reader(info);
  std::vector<Sample> samples;
  for (const char byte : feed) ASSERT_TRUE(reader.Take({&byte, 1}, samples).ok());
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[0].time_s, 1.5);
  EXPECT_THAT(samples[0].values, ElementsAre(1, 2));
  EXPECT_FALSE(samples[1].time_s.has_value());
  EXPECT_THAT(samples[1].values, ElementsAre(1, 2));
}

TEST(LslBytes, AFeedThatLiesIsRefused) {
  Info info = Board();
  const auto why = [&info](const std::string& bytes) {
    FeedReader reader(info);
    std::vector<Sample> samples;
    const auto taken = reader.Take(bytes, samples);
    return taken.ok() ? "" : taken.error().message;
  };
  const std::string start = FeedStart(info);
  EXPECT_THAT(why("LSL/110 404 Not found\r\n"), HasSubstr("404"));
  EXPECT_THAT(why("HTTP/1.1 400 Bad\r\n"), HasSubstr("none of LSL"));
  EXPECT_THAT(why("LSL/110 200 OK\r\nUID: other\r\n\r\n"), HasSubstr("another UID"));
  EXPECT_THAT(why("LSL/110 200 OK\r\nByte-Order: 4321\r\n\r\n"), HasSubstr("Byte-Order"));
  EXPECT_THAT(why(std::string(20'000, 'x')), HasSubstr("no end"));
  std::string wrong = start;
  wrong.back() ^= 1;
  EXPECT_THAT(why(wrong), HasSubstr("test samples"));
  EXPECT_THAT(why(start + '\3'), HasSubstr("neither 1 nor 2"));
  std::string never;
  AppendSample(std::numeric_limits<double>::infinity(), std::vector<double>{1, 2}, never);
  EXPECT_THAT(why(start + never), HasSubstr("time makes no sense"));
  info.format = Format::kString;
  const std::string texts = FeedStart(info);
  EXPECT_THAT(why(texts + "\1\4" + std::string(4, '\xff')), HasSubstr("at most 65536"));
  EXPECT_THAT(why(texts + "\1\3"), HasSubstr("neither 1, 2, 4 nor 8"));
}

/// Outlets on this host's loopback, and what their clients get.
class LslOutletsTest : public testing::Test {
 protected:
  void SetUp() override {
    auto opened = Outlets::Open(io_, {});
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    outlets_ = std::move(*opened);
    Info info = Board();
    info.channels = 200;
    stream_ = outlets_->Add(std::move(info)).value();
  }

  /// A connection with so small a buffer of the kernel that what is not read waits in the outlet.
  boost::asio::ip::tcp::socket Connect(const std::string& request) {
    boost::asio::ip::tcp::socket socket(io_);
    socket.open(boost::asio::ip::tcp::v4());
    socket.set_option(boost::asio::socket_base::receive_buffer_size(4096));
    socket.connect({boost::asio::ip::make_address("127.0.0.1"), outlets_->info(stream_).data_port});
    boost::asio::write(socket, boost::asio::buffer(request));
    socket.non_blocking(true);
    return socket;
  }
  /// Runs what is due, and reads what is there.
  std::string Read(boost::asio::ip::tcp::socket& socket) {
    std::string all(1 << 16, '\0');
    for (int i = 0; i < 3; ++i) io_.poll();
    boost::system::error_code error;
    all.resize(socket.read_some(boost::asio::buffer(all), error));
    closed_ = error && error != boost::asio::error::would_block;
    return all;
  }
  template <typename Condition>
  void Until(const Condition& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition() && std::chrono::steady_clock::now() < end)
      io_.run_one_for(std::chrono::milliseconds(1));
    ASSERT_TRUE(condition());
  }

  boost::asio::io_context io_;
  std::unique_ptr<Outlets> outlets_;
  std::size_t stream_ = 0;
  bool closed_ = false;
};

TEST_F(LslOutletsTest, AReaderThatDoesNotReadIsDroppedAndOthersGetAll) {
  const Info& info = outlets_->info(stream_);
  auto reading = Connect(FeedRequest(info)), idle = Connect(FeedRequest(info));
  Until([&] { return outlets_->report(stream_).feeds == 2; });
  FeedReader feed(info);
  std::vector<Sample> samples;
  const std::vector<double> values(info.channels, 0.5);
  // 1.6 KiB each: 6 MiB are more than what both kernels' buffers and the outlet hold.
  constexpr std::size_t kSamples = 4000;
  for (std::size_t i = 0; i < kSamples; ++i) {
    outlets_->Push(stream_, double(i), values);
    while (true) {
      const std::string bytes = Read(reading);
      if (bytes.empty()) break;
      ASSERT_TRUE(feed.Take(bytes, samples).ok());
    }
  }
  Until([&] {
    EXPECT_TRUE(feed.Take(Read(reading), samples).ok());
    return samples.size() == kSamples;
  });
  for (std::size_t i = 0; i < kSamples; ++i) ASSERT_EQ(samples[i].time_s, double(i));
  EXPECT_EQ(outlets_->report(stream_).dropped, 1u);
}

TEST_F(LslOutletsTest, TheCopOfTwoBoardsIsWeightedByTheirLoadsAndInW) {
  LslStreams streams(*outlets_, {"cop"});
  streams.Begin("footingd", 100);
  v1::Tick tick;
  v1::RigSetup& rig = *tick.mutable_setup()->add_rigs();
  rig.set_rig("main");
  rig.mutable_layout()->set_preset("custom");
  rig.mutable_layout()->mutable_left()->set_y_m(0.3);
  rig.mutable_layout()->mutable_right()->set_y_m(-0.3);
  for (const auto& [device, role, load_n, right_m, front_m] :
       {std::tuple(1u, v1::DEVICE_ROLE_LEFT_BOARD, 300.0, 0.1, 0.05),
        {2u, v1::DEVICE_ROLE_RIGHT_BOARD, 100.0, 0.0, 0.0}}) {
    v1::DeviceStatus& status = *tick.mutable_status()->add_devices();
    status.set_device(device);
    status.set_rig("main");
    status.set_role(role);
    v1::BoardSample& sample = *tick.mutable_boards()->add_samples();
    sample.set_device(device);
    sample.set_sampled_ns(2'500'000'000);
    sample.set_total_n(load_n);
    sample.set_cop_valid(true);
    sample.set_cop_x_m(right_m);
    sample.set_cop_y_m(front_m);
  }
  streams.Take(tick, 500'000'000);
  ASSERT_EQ(outlets_->size(), 2u);
  stream_ = 1;
  const Info& info = outlets_->info(stream_);
  EXPECT_EQ(info.name, "footingd/cop/main");
  auto reading = Connect(FeedRequest(info));
  Until([&] { return outlets_->report(stream_).feeds == 1; });
  streams.Take(tick, 500'000'000);
  FeedReader feed(info);
  std::vector<Sample> samples;
  Until([&] {
    EXPECT_TRUE(feed.Take(Read(reading), samples).ok());
    return !samples.empty();
  });
  EXPECT_NEAR(samples[0].time_s.value_or(0), 2.0, 1e-12);  // The server's clock is 0.5 s ahead.
  // In W (x forward, y left): left board (0.05, 0.3 - 0.1) with 300 N, right one (0, -0.3) with
  // 100.
  EXPECT_NEAR(samples[0].values.at(0), 400, 1e-9);
  EXPECT_NEAR(samples[0].values.at(1), 300 * 0.05 / 400, 1e-12);
  EXPECT_NEAR(samples[0].values.at(2), (300 * 0.2 - 100 * 0.3) / 400, 1e-12);
}

TEST_F(LslOutletsTest, BadRequestsAreAnsweredAndClosed) {
  for (const auto& [request, answer] : std::vector<std::pair<std::string, std::string>>{
           {"LSL:streamfeed/110 other\r\n\r\n", "LSL/110 404"},
           {"GET / HTTP/1.1\r\n\r\n", "LSL/110 400"},
           {std::string(20'000, '\xff'), "LSL/110 413"},
           {"LSL:fullinfo\r\n", "<?xml version"}}) {
    auto socket = Connect(request);
    std::string got;
    Until([&] {
      got += Read(socket);
      return closed_;
    });
    EXPECT_EQ(got.substr(0, answer.size()), answer);
  }
}

TEST_F(LslOutletsTest, ANetworksAddressNeedsItsOption) {
  for (const auto& [interface, says] :
       std::vector<std::pair<std::string, std::string>>{{"192.0.2.99", "--insecure-lan"},
                                                        {"eth0", "not an IPv4 address"},
                                                        {"0.0.0.0", "--insecure-lan"}}) {
    OutletsOptions options;
    options.interface = interface;
    const auto opened = Outlets::Open(io_, options);
    ASSERT_FALSE(opened.ok());
    EXPECT_EQ(opened.error().kind, ErrorKind::kUsage);
    EXPECT_THAT(opened.error().message, HasSubstr(says));
  }
  OutletsOptions elsewhere;
  elsewhere.interface = "198.51.100.77";
  elsewhere.insecure_lan = true;
  EXPECT_THAT(Outlets::Open(io_, elsewhere).error().message, HasSubstr("has no such address"));
}

}  // namespace
}  // namespace footing::log_client::lsl
