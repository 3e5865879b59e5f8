#pragma once
/// Text in files of XML.
#include <string>
#include <string_view>

namespace dss {

/// Text with its special characters written out. Control characters, which XML cannot have, become
/// question marks.
inline std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += static_cast<unsigned char>(c) < ' ' ? '?' : c;
  }
  return out;
}

} // namespace dss
