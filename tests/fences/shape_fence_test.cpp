// SPDX-License-Identifier: Apache-2.0
#include "fences/shape_fence.hpp"

#include <gtest/gtest.h>

namespace meridian::fences {
namespace {

std::vector<SourceFile> sources_of(const std::vector<const char*>& folders) {
  std::vector<SourceFile> files;
  for (const char* const folder : folders) {
    for (SourceFile& file : read_tree(MERIDIAN_SOURCE_DIR, folder, {".hpp", ".cpp"})) {
      files.push_back(std::move(file));
    }
  }
  EXPECT_GT(files.size(), 30U) << "the fence saw hardly any file";
  return files;
}

std::size_t count_functions(const std::vector<SourceFile>& files) {
  std::size_t count = 0;
  for (const SourceFile& file : files) count += read_shapes(file).functions.size();
  return count;
}

TEST(ShapeFence, FunctionsOfTheCoreAreShortAndFlat) {
  const auto files = sources_of({"include/meridian", "service/core"});
  EXPECT_GT(count_functions(files), 1000U) << "the fence saw hardly any function";
  EXPECT_EQ(to_text(find_large_functions(files)), "");
}

TEST(ShapeFence, ClassesOfCoreProtocolAndReadersHaveFewFlags) {
  const auto files = sources_of({"include/meridian", "service/core", "service/protocol",
                                 "service/programs/cl", "service/programs/nc"});
  EXPECT_EQ(to_text(find_flags(files)), "");
}

/// Build files and page sources count as well.
TEST(ShapeFence, FoldersHoldNoMoreThanAReaderCanSee) {
  std::vector<SourceFile> files;
  for (const char* const folder : {"include", "service"}) {
    for (SourceFile& file : read_tree(MERIDIAN_SOURCE_DIR, folder, {})) {
      files.push_back(std::move(file));
    }
  }
  EXPECT_GT(files.size(), 1000U) << "the fence saw hardly any file";
  EXPECT_EQ(to_text(find_crowded_folders(files)), "");
}

TEST(ShapeFence, CatchesACrowdedFolderAndLeavesItsRoomsOut) {
  std::vector<SourceFile> files;
  for (int n = 0; n < kMaxFiles; ++n) files.push_back({"a/b/" + std::to_string(n) + ".cpp", {}});
  files.push_back({"a/b/c/0.cpp", {}});
  EXPECT_EQ(to_text(find_crowded_folders(files)), "");
  files.push_back({"a/b/d.hpp", {}});
  EXPECT_EQ(to_text(find_crowded_folders(files)), "a/b: 26 files\n");
}

SourceFile source(const std::string& text) { return {"a.cpp", split_lines(text)}; }

std::string body_of(int lines) {
  std::string text = "int long_one(int a = 1) noexcept {\n";
  for (int n = 2; n < lines; ++n) text += "  a += 1;\n";
  return text + "}\n";
}

TEST(ShapeFence, CatchesALongFunctionThatDoesNotSayWhy) {
  EXPECT_EQ(to_text(find_large_functions({source(body_of(60))})), "");
  EXPECT_EQ(to_text(find_large_functions({source("\n" + body_of(61))})),
            "a.cpp:2: 61 lines: int long_one(int a = 1) noexcept\n");
  EXPECT_EQ(to_text(find_large_functions({source("// Long: a table.\n" + body_of(61))})), "");
  EXPECT_NE(to_text(find_large_functions({source("// Long: a table.\n\n" + body_of(61))})), "");
}

TEST(ShapeFence, CatchesADeepFunctionThatDoesNotSayWhy) {
  const std::string inner = "    for (int i = 0; i < 3; ++i) {\n      if (a) {\n        return;\n";
  const std::string four = "void f(bool a) {\n  while (a) {\n" + inner + "      }\n    }\n  }\n}\n";
  EXPECT_EQ(to_text(find_large_functions({source(four)})), "");
  const std::string five = "void f(bool a) {\n  do {\n  while (a) {\n" + inner +
                           "      }\n    }\n  }\n  } while (a);\n}\n";
  EXPECT_EQ(to_text(find_large_functions({source(five)})),
            "a.cpp:1: 5 levels deep: void f(bool a)\n");
  EXPECT_EQ(to_text(find_large_functions({source("// Deep: four sums.\n" + five)})), "");
}

TEST(ShapeFence, CountsALambdaAsALevelAndAnInitialiserAsNone) {
  const Shapes lambda = read_shapes(source("void f() {\n  g([&](int a) { return a; });\n}\n"));
  ASSERT_EQ(lambda.functions.size(), 1U);
  EXPECT_EQ(lambda.functions[0].depth, 2);
  const Shapes list = read_shapes(source("void f() {\n  const std::array a = {X{1}, X{2}};\n}\n"));
  ASSERT_EQ(list.functions.size(), 1U);
  EXPECT_EQ(list.functions[0].depth, 1);
}

TEST(ShapeFence, FindsMembersConstructorsAndOperators) {
  const Shapes shapes = read_shapes(
      source("namespace a {\nclass B {\n public:\n  explicit B(int c) : c_(c), d_{c} { e(); }\n"
             "  bool operator==(const B&) const noexcept { return true; }\n"
             "  template <class T> [[nodiscard]] int f(T t = {}) const { return c_; }\n"
             " private:\n  int c_ = 0, d_{};\n};\n}  // namespace a\n"
             "constexpr int kTable[] = {1, 2};\nenum class E { kA };\n"));
  ASSERT_EQ(shapes.functions.size(), 3U);
  ASSERT_EQ(shapes.classes.size(), 1U);
  EXPECT_EQ(shapes.classes[0].head, "class B");
}

TEST(ShapeFence, CatchesAClassOfManyFlagsThatDoesNotSayWhy) {
  const std::string head = "class A {\n public:\n  bool is_a() const { return a_; }\n private:\n";
  const std::string three = "  bool a_ = false, b_{true};\n  std::atomic<bool> c_{false};\n";
  const std::string nested = "  struct B {\n    bool d = false;\n  };\n";
  const std::string tail = "  static constexpr bool kE = true;\n};\n";
  EXPECT_EQ(to_text(find_flags({source(head + three + nested + tail)})), "");
  const std::string four = head + three + nested + "  mutable bool f_ = false;\n" + tail;
  EXPECT_EQ(to_text(find_flags({source(four)})), "a.cpp:1: 4 flags: class A\n");
  EXPECT_EQ(to_text(find_flags({source("// Flags: of four switches.\n" + four)})), "");
}

TEST(ShapeFence, ReadsPastTextThatLooksLikeCode) {
  const Shapes shapes = read_shapes(
      source("// void a() {\n/* void b() { */\nconst char* c = \"void d() {\";\nchar e = '{';\n"
             "#define F void f() {\nint g = 1'000;\nauto h = R\"(void i() {)\";\nvoid j() {}\n"));
  ASSERT_EQ(shapes.functions.size(), 1U);
  EXPECT_EQ(shapes.functions[0].head, "void j()");
}

}  // namespace
}  // namespace meridian::fences
