/// LD_PRELOAD: open("/dev/hidrawN") becomes a connection to the SOCK_SEQPACKET socket hidrawN in
/// $FOOTING_BENCH_DIR: one read is one report, poll and hang-up are the kernel's own. ioctls go to
/// the socket hidrawN.control, faults and the count of reads through the file hidrawN.page. Every
/// other call goes on, to libumockdev-preload and libc. Built without sanitizers.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "tests/device_faults/node_page.h"

namespace {

using footing::device_faults::NodePage;

constexpr int kDescriptors = 4096;
constexpr unsigned kMaxIoctlBytes = 8192;

struct OpenNode {
  NodePage* page = nullptr;
  unsigned index = 0;
  int lock = -1;
  char name[24] = {};
};
OpenNode nodes[kDescriptors];

template <typename Function>
Function Next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}
using OpenCall = int (*)(const char*, int, ...);
using CloseCall = int (*)(int);

OpenNode* NodeOf(int descriptor) {
  if (descriptor < 0 || descriptor >= kDescriptors || nodes[descriptor].page == nullptr) {
    return nullptr;
  }
  return &nodes[descriptor];
}

bool PathOf(char (&path)[108], const char* name, const char* suffix) {
  const char* folder = std::getenv("FOOTING_BENCH_DIR");
  if (folder == nullptr) return false;
  return std::snprintf(path, sizeof(path), "%s/%s%s", folder, name, suffix) <
         static_cast<int>(sizeof(path));
}

int Connect(const char* name, const char* suffix) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (!PathOf(address.sun_path, name, suffix)) {
    errno = ENODEV;
    return -1;
  }
  const int descriptor = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return -1;
  if (connect(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
    static const auto next_close = Next<CloseCall>("close");
    next_close(descriptor);
    errno = ENODEV;
    return -1;
  }
  return descriptor;
}

int OpenIt(const char* name) {
  static const auto next_open = Next<OpenCall>("open");
  static const auto next_close = Next<CloseCall>("close");
  char path[108];
  if (!PathOf(path, name, ".page")) {
    errno = ENOENT;
    return -1;
  }
  const int file = next_open(path, O_RDWR | O_CLOEXEC);
  if (file < 0) return -1;
  void* memory = mmap(nullptr, sizeof(NodePage), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  next_close(file);
  if (memory == MAP_FAILED) return -1;
  auto* page = static_cast<NodePage*>(memory);
  int error = page->gone.load() != 0 ? ENODEV : page->open_errno.load();
  int descriptor = -1;
  if (error == 0) {
    descriptor = Connect(name, "");
    if (descriptor < 0) error = errno;
  }
  if (descriptor >= kDescriptors || (error == 0 && page->opens.load() >= NodePage::kMaxOpens)) {
    next_close(descriptor);
    error = EMFILE;
  }
  if (error != 0) {
    munmap(memory, sizeof(NodePage));
    errno = error;
    return -1;
  }
  OpenNode& node = nodes[descriptor];
  node.index = page->opens.fetch_add(1);
  std::snprintf(node.name, sizeof(node.name), "%s", name);
  node.page = page;
  // The bench counts this opening's reads by its index.
  const unsigned index = node.index;
  send(descriptor, &index, sizeof(index), MSG_NOSIGNAL);
  return descriptor;
}

/// The name of a node of ours in the path, or null.
const char* OurNode(const char* path) {
  if (path == nullptr || std::strncmp(path, "/dev/hidraw", 11) != 0) return nullptr;
  return std::getenv("FOOTING_BENCH_DIR") != nullptr ? path + 5 : nullptr;
}

/// One of a number of faults to come.
bool TakeFault(std::atomic<std::int32_t>& faults) {
  std::int32_t left = faults.load();
  while (left > 0) {
    if (faults.compare_exchange_weak(left, left - 1)) return true;
  }
  return false;
}

void Count(const OpenNode& node) {
  const std::uint32_t reads = node.page->reads[node.index].fetch_add(1) + 1;
  if (reads % footing::device_faults::kCpuEveryReports != 0) return;
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  node.page->cpu_ns[node.index].store(time.tv_sec * 1'000'000'000LL + time.tv_nsec);
  node.page->cpu_reads[node.index].store(reads);
}

/// Here and not where it arrives: the bench may be late to look.
void StampWrite(const OpenNode& node) {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  const std::int64_t now_ns = time.tv_sec * 1'000'000'000LL + time.tv_nsec;
  const std::int64_t since_ns = now_ns - node.page->written_ns[node.index].exchange(now_ns);
  if (since_ns < node.page->closest_writes_ns) node.page->closest_writes_ns = since_ns;
}

/// Request and answer are each one packet: number and argument; result and argument.
int Ioctl(const OpenNode& node, unsigned long request, void* argument) {
  static const auto next_close = Next<CloseCall>("close");
  if (_IOC_TYPE(request) != 'H') {
    errno = ENOTTY;
    return -1;
  }
  if (node.page->gone.load() != 0) {
    errno = ENODEV;
    return -1;
  }
  const int control = Connect(node.name, ".control");
  if (control < 0) return -1;
  unsigned char bytes[kMaxIoctlBytes];
  const unsigned size = _IOC_SIZE(request);
  // Only the size goes in for HIDIOCGRDESC; the rest may lie outside what the caller has.
  const unsigned in = _IOC_NR(request) == 2 ? 4 : size;
  const auto number = static_cast<std::uint32_t>(request);
  std::memcpy(bytes, &number, 4);
  std::memcpy(bytes + 4, argument, in);
  send(control, bytes, 4 + in, MSG_NOSIGNAL);
  const ssize_t received = recv(control, bytes, sizeof(bytes), 0);
  next_close(control);
  if (received < 4) {
    errno = ENODEV;
    return -1;
  }
  std::int32_t result = 0;
  std::memcpy(&result, bytes, 4);
  if (result < 0) {
    errno = -result;
    return -1;
  }
  const auto out = static_cast<unsigned>(received) - 4;
  std::memcpy(argument, bytes + 4, out < size ? out : size);
  return result;
}

}  // namespace

extern "C" {

#define FOOTING_SHIM_OPEN(name)                                \
  int name(const char* path, int flags, ...) {                 \
    if (const char* node = OurNode(path)) return OpenIt(node); \
    va_list list;                                              \
    va_start(list, flags);                                     \
    const mode_t mode = va_arg(list, mode_t);                  \
    va_end(list);                                              \
    static const auto next = Next<OpenCall>(#name);            \
    return next(path, flags, mode);                            \
  }
FOOTING_SHIM_OPEN(open)
FOOTING_SHIM_OPEN(open64)
FOOTING_SHIM_OPEN(__open_2)
FOOTING_SHIM_OPEN(__open64_2)

ssize_t read(int descriptor, void* bytes, size_t size) {
  OpenNode* node = NodeOf(descriptor);
  if (node == nullptr || size == 0) {
    static const auto next = Next<ssize_t (*)(int, void*, size_t)>("read");
    return next(descriptor, bytes, size);
  }
  unsigned char packet[kMaxIoctlBytes];
  const ssize_t received = recv(descriptor, packet, sizeof(packet), 0);
  if (received < 0) {
    if (errno == ECONNRESET) errno = EIO;
    return -1;
  }
  if (received == 0) {
    errno = EIO;  // As hidraw after an unplug.
    return -1;
  }
  Count(*node);
  if (TakeFault(node->page->read_faults)) {
    errno = node->page->read_errno.load();
    return -1;
  }
  // The first byte only makes a packet of an empty report.
  const size_t report = static_cast<size_t>(received) - 1;
  const size_t copied = report < size ? report : size;
  std::memcpy(bytes, packet + 1, copied);
  return static_cast<ssize_t>(copied);
}

ssize_t write(int descriptor, const void* bytes, size_t size) {
  OpenNode* node = NodeOf(descriptor);
  if (node == nullptr) {
    static const auto next = Next<ssize_t (*)(int, const void*, size_t)>("write");
    return next(descriptor, bytes, size);
  }
  if (node->page->gone.load() != 0) {
    errno = ENODEV;
    return -1;
  }
  while (node->page->write_blocks.load() != 0) usleep(1000);
  if (TakeFault(node->page->write_faults)) {
    errno = node->page->write_errno.load();
    return -1;
  }
  StampWrite(*node);
  const ssize_t sent = send(descriptor, bytes, size, MSG_NOSIGNAL);
  if (sent < 0 && (errno == EPIPE || errno == ECONNRESET)) errno = ENODEV;
  return sent;
}

int ioctl(int descriptor, unsigned long request, ...) {
  va_list list;
  va_start(list, request);
  void* argument = va_arg(list, void*);
  va_end(list);
  if (const OpenNode* node = NodeOf(descriptor)) return Ioctl(*node, request, argument);
  static const auto next = Next<int (*)(int, unsigned long, ...)>("ioctl");
  return next(descriptor, request, argument);
}

/// The lock of a node is that of its file, for as long as this opening lives.
int flock(int descriptor, int operation) {
  static const auto next = Next<int (*)(int, int)>("flock");
  OpenNode* node = NodeOf(descriptor);
  if (node == nullptr) return next(descriptor, operation);
  if (node->lock < 0) {
    static const auto next_open = Next<OpenCall>("open");
    char path[108];
    if (PathOf(path, node->name, ".page")) node->lock = next_open(path, O_RDWR | O_CLOEXEC);
  }
  return next(node->lock, operation);
}

int close(int descriptor) {
  static const auto next = Next<CloseCall>("close");
  if (OpenNode* node = NodeOf(descriptor)) {
    if (node->lock >= 0) next(node->lock);
    munmap(node->page, sizeof(NodePage));
    *node = OpenNode();
  }
  return next(descriptor);
}

}  // extern "C"
