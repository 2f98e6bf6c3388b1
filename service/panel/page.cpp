// SPDX-License-Identifier: Apache-2.0
#include "service/panel/page.hpp"

#include <algorithm>
#include <array>

// Laid down by page_data.c.in.
extern "C" {
extern const char meridian_page_index[], meridian_page_index_end[];
extern const char meridian_page_script[], meridian_page_script_end[];
extern const char meridian_page_style[], meridian_page_style_end[];
extern const char meridian_page_notices[], meridian_page_notices_end[];
extern const char meridian_page_login[], meridian_page_login_end[];
extern const char meridian_page_viewer[], meridian_page_viewer_end[];
}

namespace meridian::panel {
namespace {

[[nodiscard]] std::string_view bytes(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

std::optional<PageFile> find_page_file(std::string_view path) {
  const std::array<PageFile, 4> files{{
      {"/", "text/html; charset=utf-8", bytes(meridian_page_index, meridian_page_index_end), true},
      {"/panel.js", "text/javascript; charset=utf-8",
       bytes(meridian_page_script, meridian_page_script_end), true},
      {"/panel.css", "text/css; charset=utf-8", bytes(meridian_page_style, meridian_page_style_end),
       true},
      {"/notices.txt", "text/plain; charset=utf-8",
       bytes(meridian_page_notices, meridian_page_notices_end), true},
  }};
  const auto found = std::find_if(files.begin(), files.end(),
                                  [path](const PageFile& file) { return file.path == path; });
  if (found == files.end()) return std::nullopt;
  return *found;
}

std::string_view login_html() { return bytes(meridian_page_login, meridian_page_login_end); }

std::string_view viewer_html() { return bytes(meridian_page_viewer, meridian_page_viewer_end); }

}  // namespace meridian::panel
