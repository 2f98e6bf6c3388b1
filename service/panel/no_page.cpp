// SPDX-License-Identifier: Apache-2.0
#include "service/panel/page.hpp"

/// Of a build without the page (MERIDIAN_PANEL is off).
namespace meridian::panel {

std::optional<PageFile> find_page_file(std::string_view) { return std::nullopt; }
std::string_view viewer_html() { return {}; }

}  // namespace meridian::panel
