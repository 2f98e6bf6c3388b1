// SPDX-License-Identifier: Apache-2.0
#include "service/text/checksum.hpp"

#include <gtest/gtest.h>

namespace meridian::text {
namespace {

TEST(Checksum, IsFnv1aOf64Bits) {
  EXPECT_EQ(checksum_of(""), 0xCBF29CE484222325U);
  EXPECT_EQ(checksum_of("a"), 0xAF63DC4C8601EC8CU);
  EXPECT_EQ(checksum_of("foobar"), 0x85944171F73967E8U);
}

TEST(Checksum, OfPiecesIsThatOfTheWhole) {
  Checksum sum;
  for (const char* piece : {"foo", "", "bar"}) sum.add(piece);
  EXPECT_EQ(sum.sum(), checksum_of("foobar"));
}

}  // namespace
}  // namespace meridian::text
