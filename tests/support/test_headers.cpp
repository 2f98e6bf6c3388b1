// SPDX-License-Identifier: Apache-2.0

// Holds the precompiled headers that the tests share; has no tests of its own.
