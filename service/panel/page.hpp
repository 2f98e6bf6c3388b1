// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

/// The page, as it was built into this program (page/, docs/panel.md).
namespace meridian::panel {

/// A file of the page as a browser gets it.
struct PageFile {
  std::string_view path;  ///< "/panel.js"
  std::string_view type;  ///< MIME type
  std::string_view bytes;
  bool is_gzip = false;
};

/// Returns the file of that path; nothing where the page has none.
[[nodiscard]] std::optional<PageFile> find_page_file(std::string_view path);

/// The page that asks for the token: HTML, with kLoginReason where a reason belongs.
[[nodiscard]] std::string_view login_html();
inline constexpr std::string_view kLoginReason = "<!--reason-->";

/// The page as one HTML file that needs no server; empty where this build has no page.
[[nodiscard]] std::string_view viewer_html();

}  // namespace meridian::panel
