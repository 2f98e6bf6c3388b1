// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

struct mg_connection;

namespace meridian::panel {

/// Answers with the page that asks for the token. `reason`: why the last one was refused; empty:
/// there was none.
void answer_login(mg_connection* connection, const char* status, std::string_view reason);

}  // namespace meridian::panel
