// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tl/expected.hpp>

namespace meridian {

/// A value, or the reason why there is none. Test it first, then use `*`: the core never throws.
template <class T, class E>
using Expected = tl::expected<T, E>;

}  // namespace meridian
