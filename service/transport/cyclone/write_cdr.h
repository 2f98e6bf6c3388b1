// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stddef.h>
#include <stdint.h>

/// Samples that are serialized already. In C: Cyclone's inner headers are no C++.
#ifdef __cplusplus
extern "C" {
#endif

/// Writes a message as it stands on the wire, its four bytes of encapsulation first. Cyclone checks
/// it against the type of the DDS writer. 0: sent; else a return code of DDS.
int32_t meridian_write_cdr(int32_t writer, const void* message, size_t bytes);

#ifdef __cplusplus
}
#endif
