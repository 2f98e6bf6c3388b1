// SPDX-License-Identifier: Apache-2.0
#include "service/panel/serve/login_page.hpp"

#include <string>

#include "service/panel/page.hpp"
#include "service/panel/serve/http.hpp"

namespace meridian::panel {

void answer_login(mg_connection* connection, const char* status, std::string_view reason) {
  std::string page(login_html());
  if (const auto at = page.find(kLoginReason); at != std::string::npos) {
    page.replace(at, kLoginReason.size(), reason);
  }
  http::answer(connection, status, page, {.type = http::kHtml});
}

}  // namespace meridian::panel
