#include "daemon/offline/analysis/svg.h"

#include <charconv>

namespace footing::plot {
namespace {

std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return escaped;
}

}  // namespace

std::string Number(double value) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6);
  return {text.data(), end.ptr};
}

std::string Open(double width, double height) {
  return "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " + Number(width) + " " +
         Number(height) + "' font-family='sans-serif' font-size='12' fill='#222'>\n" +
         "<rect width='100%' height='100%' fill='white'/>\n";
}

std::string Label(double x, double y, const std::string& anchor, const std::string& text,
                  const std::string& more) {
  return "<text x='" + Number(x) + "' y='" + Number(y) + "' text-anchor='" + anchor + "' " + more +
         ">" + Escaped(text) + "</text>\n";
}

std::string Line(double x1, double y1, double x2, double y2, const std::string& colour,
                 const std::string& more) {
  return "<line x1='" + Number(x1) + "' y1='" + Number(y1) + "' x2='" + Number(x2) + "' y2='" +
         Number(y2) + "' stroke='" + colour + "'" + (more.empty() ? "" : " " + more) + "/>\n";
}

}  // namespace footing::plot
