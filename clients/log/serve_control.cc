#include "clients/log/serve_control.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <deque>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <sys/socket.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/write.hpp>
#include <nlohmann/json.hpp>

#include "clients/log/commands.h"
#include "clients/log/lsl.h"
#include "clients/log/record.h"
#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/net/client.h"
#include "common/net/listener.h"
#include "common/runtime/clock.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace footing::log_client {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostValueBytes = 200;
constexpr int kMostRuns = 9999;

/// An absolute path without symbolic links, as far as it exists.
fs::path Resolved(const fs::path& path) {
  std::error_code error;
  fs::path resolved = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? path.lexically_normal() : resolved;
}

bool IsWithin(const fs::path& path, const fs::path& folder) {
  const auto [of_folder, of_path] =
      std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return of_folder == folder.end() || of_folder->empty();
}

std::string Replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
    text.replace(at, what.size(), with);
    at += with.size();
  }
  return text;
}

/// Without the parts in brackets whose field is empty.
std::string WithoutEmptyParts(std::string text, const std::map<std::string, std::string>& fields) {
  for (std::size_t open = text.find('['); open != std::string::npos; open = text.find('[', open)) {
    const std::size_t close = text.find(']', open);
    if (close == std::string::npos) break;
    std::string part = text.substr(open + 1, close - open - 1);
    const bool empty = std::any_of(fields.begin(), fields.end(), [&part](const auto& field) {
      return field.second.empty() && part.find(field.first) != std::string::npos;
    });
    if (empty) part.clear();
    text.replace(open, close - open + 1, part);
    open += part.size();
  }
  return text;
}

}  // namespace

RecordingName::RecordingName(const fs::path& root) : outermost_(Resolved(root)) {
  fields_.root = outermost_;
}

Result<void> RecordingName::SetOne(const std::string& option, const std::string& value,
                                   Fields& fields) const {
  const std::map<std::string, std::string*> texts = {{"participant", &fields.participant},
                                                     {"session", &fields.session},
                                                     {"task", &fields.task},
                                                     {"acquisition", &fields.acquisition},
                                                     {"modality", &fields.modality}};
  if (const auto text = texts.find(option); text != texts.end()) {
    *text->second = value;
  } else if (option == "root") {
    if (value.find('\\') != std::string::npos)
      return UsageError("root " + value + " is a folder of Windows; this recorder's have a /");
    fields.root = Resolved(outermost_ / value);
  } else if (option == "template") {
    // LabRecorder's clients on Windows write backslashes.
    fields.name_template = Replaced(value, "\\", "/");
  } else if (option == "run") {
    const auto run = text::As<int>(value);
    if (!run || *run < 0 || *run > kMostRuns)
      return UsageError("run " + value + " is not a number from 0 to " + std::to_string(kMostRuns));
    fields.run = *run;
  } else {
    return UsageError("unknown option " + option +
                      "; there are: root, template, participant, session, task, run, acquisition, "
                      "modality");
  }
  return {};
}

namespace {

/// The name that the fields make, below the root.
fs::path NameOf(const std::string& name_template, std::map<std::string, std::string> fields,
                int run) {
  std::string digits = std::to_string(run);
  digits.insert(0, digits.size() < 3 ? 3 - digits.size() : 0, '0');  // As LabRecorder: 007.
  fields["%r"] = fields["%n"] = digits;
  std::string name = WithoutEmptyParts(name_template, fields);
  for (const auto& [placeholder, value] : fields) name = Replaced(name, placeholder, value);
  if (name.ends_with(".xdf")) name.erase(name.size() - 4);
  return name.ends_with(".mcap") ? name : name + ".mcap";
}

}  // namespace

Result<void> RecordingName::Check(const Fields& fields) const {
  if (!IsWithin(fields.root, outermost_)) {
    return UsageError("root " + fields.root.string() + " is not within " + outermost_.string() +
                      ", the folder of this recorder; start it with another --root");
  }
  const fs::path name = fs::path(fields.name_template).lexically_normal();
  if (fields.name_template.empty() || name.is_absolute() || !name.has_filename()) {
    return UsageError("template \"" + fields.name_template +
                      "\" is not a file's name below the root, such as sub-%p/%b_%r.mcap");
  }
  for (const std::string& value : {fields.name_template, fields.participant, fields.session,
                                   fields.task, fields.acquisition, fields.modality}) {
    const fs::path parts(value);
    if (std::find(parts.begin(), parts.end(), "..") != parts.end())
      return UsageError("\"" + value + "\" leads out of the root; a name may not have ..");
  }
  for (const std::string& value :
       {fields.participant, fields.session, fields.task, fields.acquisition, fields.modality}) {
    if (value.find('/') != std::string::npos)
      return UsageError("\"" + value + "\" may not have a /; put folders into the template");
  }
  return {};
}

Result<void> RecordingName::Set(std::string_view options) {
  Fields fields = fields_;
  while (true) {
    const std::size_t open = options.find_first_not_of(' ');
    if (open == std::string_view::npos) break;
    const std::size_t colon = options.find(':', open), close = options.find('}', open);
    if (options[open] != '{' || colon == std::string_view::npos ||
        close == std::string_view::npos || colon > close) {
      return UsageError(
          "filename takes {option:value} ..., such as: filename {participant:P01} {task:walk}");
    }
    const std::string option(options.substr(open + 1, colon - open - 1));
    const std::string value(options.substr(colon + 1, close - colon - 1));
    if (value.find('{') != std::string::npos)
      return UsageError("{" + option + ": has no closing brace");
    if (value.size() > kMostValueBytes || !text::IsPrintable(value))
      return UsageError(option + " must have at most " + std::to_string(kMostValueBytes) +
                        " bytes without control characters");
    if (const auto set = SetOne(option, value, fields); !set) return set;
    options.remove_prefix(close + 1);
  }
  if (const auto checked = Check(fields); !checked) return checked;
  fields_ = std::move(fields);
  return {};
}

fs::path RecordingName::Path() const {
  const std::map<std::string, std::string> fields = {{"%p", fields_.participant},
                                                     {"%s", fields_.session},
                                                     {"%b", fields_.task},
                                                     {"%a", fields_.acquisition},
                                                     {"%m", fields_.modality}};
  const auto path = [&](int run) {
    return fields_.root / NameOf(fields_.name_template, fields, run);
  };
  if (fields_.run) return path(*fields_.run);
  std::error_code ignored;
  int run = 1;
  while (run < kMostRuns && path(run) != path(0) && fs::exists(path(run), ignored)) ++run;
  return path(run);
}

Result<MarkerLine> ParseMarker(std::string_view line) {
  MarkerLine marker;
  while (line.ends_with('}')) {
    const std::size_t open = line.rfind('{');
    if (open == std::string_view::npos) break;
    const std::string option(line.substr(open + 1, line.size() - open - 2));
    if (option.starts_with("value:")) {
      marker.value = text::As<double>(option.substr(6));
      if (!marker.value || !std::isfinite(*marker.value))
        return UsageError("{" + option + "}: the value is not a number");
    } else if (option.starts_with("time_ns:")) {
      marker.time_ns = text::As<std::int64_t>(option.substr(8));
      if (!marker.time_ns)
        return UsageError("{" + option + "}: the time is not a whole number of nanoseconds");
    } else {
      break;
    }
    line.remove_suffix(line.size() - open);
    while (line.ends_with(' ')) line.remove_suffix(1);
  }
  marker.text = line;
  if (marker.text.empty())
    return UsageError("mark takes a text, such as: mark stimulus on {value:3}");
  return marker;
}

namespace {

using boost::system::error_code;
using nlohmann::ordered_json;

constexpr char kHelp[] =
    "start, stop, update, select all|none, filename {option:value}..., "
    "mark TEXT {value:NUMBER}, status";
constexpr auto kBegunPeriod = std::chrono::milliseconds(5);
constexpr std::int64_t kBeginsWithinNs = 2'000'000'000;

/// A line from a client and when it came.
struct ControlLine {
  std::optional<std::string> text;  ///< Nothing: it was too long.
  std::int64_t arrived_ns = 0;
};

using Reply = std::function<void(const std::string& answer)>;
using OnLine = std::function<void(const ControlLine& line, Reply reply)>;

std::string ErrorAnswer(const std::string& message) { return "ERROR: " + message + "\n"; }

/// When the newest bytes of a message came, by the kernel's stamp: on a busy host this process runs
/// milliseconds later. Now, where there is no stamp, as of Unix sockets, or the wall clock was set.
std::int64_t ArrivalOf(msghdr& message) {
  constexpr std::int64_t kOldestNs = 10'000'000'000;
  const std::int64_t now_ns = clock::MonotonicNs();
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr;
       part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(part), sizeof(stamp));
    const std::int64_t age_ns =
        clock::WallNs() - (stamp.tv_sec * kNanosecondsPerSecond + stamp.tv_nsec);
    if (age_ns >= 0 && age_ns <= kOldestNs) return now_ns - age_ns;
  }
  return now_ns;
}

/// One client's connection: lines, and an answer to each in their order. Lines are read while
/// earlier ones are carried out, so that each gets the time at which it came.
class ControlSession : public std::enable_shared_from_this<ControlSession> {
 public:
  static constexpr std::size_t kMostLines = 64;  ///< That wait; then nothing more is read.

  ControlSession(transport::PlainSocket socket, OnLine on_line, std::shared_ptr<void> place)
      : socket_(std::move(socket)), on_line_(std::move(on_line)), place_(std::move(place)) {}

  void Start() {
    const int on = 1;  // Without it the time of reading counts.
    setsockopt(socket_.native_handle(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof(on));
    Read();
  }
  void Refuse(const std::string& why) {
    ends_ = true;
    Write(ErrorAnswer(why));
  }

 private:
  void Read() {
    if (reading_ || ends_ || lines_.size() >= kMostLines) return;
    reading_ = true;
    socket_.async_wait(transport::PlainSocket::wait_read,
                       [self = shared_from_this()](const error_code& error) {
                         self->reading_ = false;
                         if (!self->ends_) self->OnReadable(error);
                       });
  }

  void OnReadable(const error_code& error) {
    iovec bytes{bytes_.data(), bytes_.size()};
    alignas(cmsghdr) std::array<char, 128> control{};
    msghdr message{};
    message.msg_iov = &bytes;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t count = error ? 0 : recvmsg(socket_.native_handle(), &message, MSG_DONTWAIT);
    const bool not_yet = count < 0 && (errno == EAGAIN || errno == EINTR);
    const auto keep = [this, at_ns = ArrivalOf(message)](std::optional<std::string> line) {
      if (line) line->erase(0, line->find_first_not_of(" \t"));
      if (!line || !line->empty()) lines_.push_back({std::move(line), at_ns});
    };
    if (count > 0) reader_.Take({bytes_.data(), static_cast<std::size_t>(count)}, keep);
    if (count <= 0 && !not_yet) {
      reader_.Finish(keep);
      ends_ = true;
    }
    Next();
    Read();
  }

  void Next() {
    if (busy_) return;
    if (lines_.empty()) {
      if (ends_) Close();
      return;
    }
    busy_ = true;
    const ControlLine line = std::move(lines_.front());
    lines_.pop_front();
    // A web page may send a request to a port of this host; its lines are nobody's commands.
    if (line.text && line.text->find(" HTTP/1.") != std::string::npos) {
      lines_.clear();
      ends_ = true;
      return Write(ErrorAnswer("this is not a web server"));
    }
    on_line_(line, [self = shared_from_this()](const std::string& answer) { self->Write(answer); });
  }

  void Write(const std::string& answer) {
    busy_ = true;
    answer_ = answer;
    boost::asio::async_write(socket_, boost::asio::buffer(answer_),
                             [self = shared_from_this()](const error_code&, std::size_t) {
                               self->busy_ = false;
                               self->Next();
                               self->Read();
                             });
  }

  void Close() {
    error_code ignored;  // It may be gone already.
    socket_.shutdown(transport::PlainSocket::shutdown_both, ignored);
    socket_.close(ignored);
  }

  transport::PlainSocket socket_;
  OnLine on_line_;
  std::shared_ptr<void> place_;  ///< Among the connections.
  std::array<char, LineReader::kMostBytes> bytes_{};
  LineReader reader_;
  std::deque<ControlLine> lines_;
  std::string answer_;
  bool reading_ = false;
  bool busy_ = false;  ///< A line is carried out, or its answer is being sent.
  bool ends_ = false;  ///< Nothing more is read.
};

struct ControlOptions {
  std::vector<std::string> connect;
  std::string listen = "tcp:127.0.0.1:22345";
  std::optional<std::uint16_t> port;
  std::string root = ".";
  std::vector<std::string> lsl;
  bool insecure_lan = false;
};

/// A recorder that other programs start and stop.
class ControlledRecorder {
 public:
  ControlledRecorder(boost::asio::io_context& io, std::vector<transport::Address> addresses,
                     const std::string& root, std::vector<std::string> lsl)
      : io_(io),
        addresses_(std::move(addresses)),
        lsl_(std::move(lsl)),
        name_(root),
        begins_(io),
        end_(io, [this] { OnSignal(); }) {
    for (const transport::Address& address : addresses_) AddLink(address);
  }

  Result<std::string> Listen(const transport::Address& address, bool insecure_lan) {
    transport::ListenSecurity security;
    security.insecure_lan = insecure_lan;
    auto listener = transport::Listener::Open(
        io_, address, [this](transport::Socket socket) { OnAccept(std::move(socket)); }, security);
    if (!listener) return listener.error();
    listener_ = std::move(*listener);
    return listener_->address().Text();
  }

  ordered_json Run() {
    for (const auto& link : links_) link->client->Start();
    io_.run();
    return {{"recordings", recordings_}, {"markers", markers_}, {"last_file", last_file_}};
  }

  const RecordingName& name() const { return name_; }

 private:
  static constexpr int kMostConnections = 16;

  /// A session for markers; a recording has its own.
  struct Link {
    transport::Address address;
    std::string server_id;
    std::string state = "not connected yet";
    bool live = false;
    std::unique_ptr<transport::Client> client;
  };

  void AddLink(const transport::Address& address) {
    transport::ClientOptions options;
    options.address = address;
    options.client_name = "footing-log serve-control";
    options.role = v1::ROLE_LOG;
    options.channels = {"stats"};
    options.max_hz = 1;
    options.policy = v1::QUEUE_POLICY_LATEST;
    links_.push_back(std::make_unique<Link>());
    Link* const link = links_.back().get();
    link->address = address;
    transport::ClientHandlers handlers;
    handlers.on_welcome = [link](const v1::Welcome& welcome) {
      link->server_id = welcome.server_id();
    };
    handlers.on_tick = [](const v1::Tick&) {};
    handlers.on_gap = [](const v1::Gap&) {};
    handlers.on_state = [link](transport::LinkState state, const std::string& why) {
      link->live = state == transport::LinkState::kLive;
      link->state = link->live ? "live" : why;
    };
    link->client = std::make_unique<transport::Client>(io_, options, std::move(handlers));
  }

  void OnAccept(transport::Socket socket) {
    const auto place =
        std::shared_ptr<void>(nullptr, [connections = connections_](void*) { --*connections; });
    const bool full = ++*connections_ > kMostConnections;
    const auto session = std::make_shared<ControlSession>(
        std::move(socket.plain()),
        [this](const ControlLine& line, Reply reply) { CarryOut(line, std::move(reply)); }, place);
    if (!full) return session->Start();
    session->Refuse("there are " + std::to_string(kMostConnections) + " connections already");
  }

  void CarryOut(const ControlLine& line, Reply reply) {
    if (!line.text) {
      return reply(ErrorAnswer("a line may have at most " + std::to_string(LineReader::kMostBytes) +
                               " bytes"));
    }
    const std::string& all = *line.text;
    const std::size_t blank = all.find(' ');
    const std::string word = all.substr(0, blank);
    const std::string rest = blank == std::string::npos ? "" : all.substr(blank + 1);
    if (word == "mark") return Mark(rest, line.arrived_ns, reply);
    if (word == "filename") return Answer(name_.Set(rest), reply);
    if (word == "select" && (rest == "all" || rest == "none")) return reply("OK");
    if (rest.empty() && word == "start") return Start(reply);
    if (rest.empty() && word == "stop") return Stop(reply);
    if (rest.empty() && word == "update") return reply("OK");  // Servers that come are found.
    if (rest.empty() && word == "status") return reply(text::ToText(Status()) + "\n");
    const std::string shown = text::IsPrintable(all) ? all.substr(0, 60) : "with other characters";
    reply(ErrorAnswer("unknown command " + shown + "; there are: " + kHelp));
  }

  static void Answer(const Result<void>& done, const Reply& reply) {
    if (!done) std::cerr << "error: " << done.error().message << std::endl;
    reply(done ? "OK" : ErrorAnswer(done.error().message));
  }

  std::string LinksText() const {
    std::string texts;
    for (const auto& link : links_) {
      texts += (texts.empty() ? "" : ", ") + link->address.Text() + " (" + link->state + ")";
    }
    return texts;
  }

  void Mark(const std::string& line, std::int64_t arrived_ns, const Reply& reply) {
    const auto marker = ParseMarker(line);
    if (!marker) return Answer(marker.error(), reply);
    const auto link =
        std::find_if(links_.begin(), links_.end(), [](const auto& one) { return one->live; });
    if (link == links_.end())
      return Answer(Failure("no server to mark: " + LinksText() + "; start one"), reply);
    v1::Command command;
    command.mutable_marker()->set_text(marker->text);
    if (marker->value) command.mutable_marker()->set_value(*marker->value);
    command.mutable_marker()->set_host_ns(transport::OnServersClock(
        (*link)->address, (*link)->client->clock(), marker->time_ns.value_or(arrived_ns)));
    (*link)->client->Send(std::move(command), [this, reply](const v1::CommandResult& result) {
      markers_ += result.ok() ? 1 : 0;
      Answer(result.ok() ? Result<void>() : Failure(result.message()), reply);
    });
  }

  /// An existing file keeps its contents under another name, as LabRecorder does it: NAME_old1.
  static Result<void> MakePlaceFor(const fs::path& path) {
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error)
      return Failure("cannot make the folder " + path.parent_path().string() + ": " +
                     error.message());
    if (!fs::exists(path, error)) return {};
    fs::path old = path;
    for (int i = 1; fs::exists(old, error); ++i) {
      old = path.parent_path() /
            (path.stem().string() + "_old" + std::to_string(i) + path.extension().string());
    }
    fs::rename(path, old, error);
    if (error) return Failure("cannot rename " + path.string() + ": " + error.message());
    std::cerr << path.string() << " is now " << old.string() << std::endl;
    return {};
  }

  Result<void> Begin() {
    if (recording_) {
      return Failure(recording_->path() + " is being recorded" +
                     (stopped_ ? ", and ends now; try again" : "; stop it first"));
    }
    const bool any_live =
        std::any_of(links_.begin(), links_.end(), [](const auto& link) { return link->live; });
    if (!any_live) return NoDevice("nothing to record: " + LinksText() + "; start a server");
    const fs::path path = name_.Path();
    if (const auto made = MakePlaceFor(path); !made) return made;
    RecordOptions options;
    options.addresses = addresses_;
    options.out = path.string();
    options.lsl = lsl_;
    options.version = cli::Version();
    auto recording = Recording::Create(io_, options, [this] { OnEnd(); });
    if (!recording) return recording.error();
    if (const auto started = (*recording)->Start(); !started) return started;
    recording_ = std::move(*recording);
    problem_.clear();
    stopped_ = false;
    return {};
  }

  void Start(const Reply& reply) {
    if (const auto begun = Begin(); !begun) return Answer(begun, reply);
    start_reply_ = reply;
    AnswerWhenBegun(clock::MonotonicNs() + kBeginsWithinNs);
  }

  /// "OK" says that data are coming in: of all servers that are connected, or after a while of any.
  void AnswerWhenBegun(std::int64_t until_ns) {
    const auto live = static_cast<std::size_t>(
        std::count_if(links_.begin(), links_.end(), [](const auto& link) { return link->live; }));
    const bool late = clock::MonotonicNs() > until_ns;
    if (recording_->begun() >= std::max<std::size_t>(1, late ? 1 : live)) {
      std::cerr << "recording " << recording_->path() << std::endl;
      return Answer({}, std::exchange(start_reply_, nullptr));
    }
    if (late) return StopRecording("nothing came to record within 2 s: " + LinksText());
    begins_.After(kBegunPeriod, [this, until_ns] { AnswerWhenBegun(until_ns); });
  }

  void StopRecording(const std::string& why) {
    begins_.cancel();
    if (start_reply_) Answer(Failure(why), std::exchange(start_reply_, nullptr));
    if (std::exchange(stopped_, true)) return;
    recording_->Stop();
  }

  void Stop(const Reply& reply) {
    if (!recording_) {
      const std::string problem = std::exchange(problem_, "");
      return Answer(problem.empty() ? Result<void>() : Failure(problem), reply);
    }
    stop_replies_.push_back(reply);
    StopRecording("the recording was stopped before it had begun");
  }

  /// The recording has all that it gets.
  void OnEnd() {
    begins_.cancel();
    const auto recording = std::exchange(recording_, nullptr);
    const auto report = recording->Finish();
    if (start_reply_ && !report) Answer(report.error(), std::exchange(start_reply_, nullptr));
    last_file_ = recording->path();
    recordings_ += report ? 1 : 0;
    if (report) {
      std::cerr << last_file_ << ": complete, " << report->messages << " messages, "
                << text::Fixed(report->duration_s, 1) << " s" << std::endl;
    } else if (stop_replies_.empty()) {
      problem_ = report.error().message;  // For the next stop, and for status.
      std::cerr << "error: " << problem_ << std::endl;
    }
    for (const Reply& reply : std::exchange(stop_replies_, {})) {
      Answer(report ? Result<void>() : report.error(), reply);
    }
    if (end_.asked()) io_.stop();
  }

  ordered_json Status() const {
    ordered_json out{{"recording", recording_ != nullptr},
                     {"file", recording_ ? recording_->path() : ""},
                     {"next_file", name_.Path().string()},
                     {"last_file", last_file_},
                     {"problem", problem_}};
    if (recording_) {
      const RecordReport report = recording_->Progress();
      out["duration_s"] = report.duration_s;
      out["messages"] = report.messages;
      out["missing_ticks"] = report.missing_ticks;
    }
    out["servers"] = ordered_json::array();
    for (const auto& link : links_) {
      out["servers"].push_back({{"address", link->address.Text()},
                                {"server", link->server_id},
                                {"live", link->live},
                                {"link", link->state}});
    }
    return out;
  }

  void OnSignal() {
    listener_.reset();
    if (recording_) return StopRecording("footing-log is being stopped");
    io_.stop();
  }

  boost::asio::io_context& io_;
  std::vector<transport::Address> addresses_;
  std::vector<std::string> lsl_;  ///< Queries.
  RecordingName name_;
  std::vector<std::unique_ptr<Link>> links_;
  std::unique_ptr<transport::Listener> listener_;
  std::unique_ptr<Recording> recording_;
  bool stopped_ = false;  ///< The recording is about to end.
  Reply start_reply_;     ///< While data have yet to come.
  std::vector<Reply> stop_replies_;
  std::string problem_;  ///< A recording ended by itself.
  std::string last_file_;
  int recordings_ = 0, markers_ = 0;
  /// Shared with the sessions, which end with the io_context.
  std::shared_ptr<int> connections_ = std::make_shared<int>(0);
  timer::Timer begins_;
  service_manager::ProgramEnd end_;
};

Result<ordered_json> RunServeControl(const ControlOptions& options) {
  auto addresses = RecordedAddresses(options.connect);
  if (!addresses) return addresses.error();
  const auto listen = transport::ParseAddress(
      options.port ? "tcp:127.0.0.1:" + std::to_string(*options.port) : options.listen);
  if (!listen) return listen.error();
  boost::asio::io_context io(1);
  for (const std::string& query : options.lsl) {
    if (const auto sound = lsl::CheckQuery(query); !sound)
      return UsageError("--lsl \"" + query + "\": " + sound.error().message);
  }
  ControlledRecorder recorder(io, std::move(*addresses), options.root, options.lsl);
  const auto listening = recorder.Listen(*listen, options.insecure_lan);
  if (!listening) return listening.error();
  if (options.insecure_lan) {
    std::cerr << "WARNING: everybody in this network may start and stop recordings" << std::endl;
  }
  std::cerr << "listening on " << *listening << "; recordings go to "
            << recorder.name().root().string() << std::endl;
  ordered_json out{{"listening_on", *listening}};
  out.update(recorder.Run());
  return out;
}

}  // namespace

void AddServeControlCommand(CLI::App& app, Shared& shared) {
  CLI::App* command =
      app.add_subcommand("serve-control",
                         "Let other programs start, stop and mark recordings, with the commands of "
                         "LabRecorder");
  const auto options = std::make_shared<ControlOptions>();
  command->add_option(
      "--connect", options->connect,
      "Address of a server, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT; may be repeated (default: "
      "this user's sensor and simulation servers)");
  CLI::Option* const listen =
      command
          ->add_option("--listen", options->listen,
                       "Address of the commands, tcp:HOST:PORT or unix:PATH")
          ->capture_default_str();
  command->add_option("--port", options->port, "Port of the commands on 127.0.0.1")
      ->excludes(listen);
  command
      ->add_option("--root", options->root,
                   "Folder that all recordings stay in, whatever a client asks for")
      ->capture_default_str();
  command->add_option("--lsl", options->lsl,
                      "Record the streams of the Lab Streaming Layer that match this query, too; "
                      "may be repeated");
  command->add_flag("--insecure-lan", options->insecure_lan,
                    "Allow --listen tcp: beyond this host: ANYBODY there may start, stop and mark "
                    "recordings");
  command->footer(
      "Commands, one a line; each is answered with OK, or ERROR and the reason:\n"
      "  filename {root:..} {template:sub-%p/%b_%r.mcap} {participant:P01} {session:S01} "
      "{task:walk} {run:1}\n"
      "  start | stop | update | select all | select none\n"
      "  mark TEXT {value:NUMBER}     an event in the recordings\n"
      "  status                       one line of JSON\n"
      "Examples:\n"
      "  footing-log serve-control --root ~/study\n"
      "  printf 'filename {participant:P01} {task:sway}\\nstart\\n' | nc -q 1 localhost 22345\n"
      "  echo 'mark eyes closed' | nc -q 1 localhost 22345");
  command->callback([options, &shared] { Finish(RunServeControl(*options), shared); });
}

}  // namespace footing::log_client
