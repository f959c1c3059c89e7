// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The facade as an application uses it: text in, verdict and reports out, files whole or not at
// all.
#include "holdfast/holdfast.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace holdfast {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTwoModules =
    R"({"format": "holdfast-structure", "version": 1, "modules": [[0,0,0],[0,0,1]]})";

class Files : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }

  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_ =
      fs::temp_directory_path() /
      ("holdfast_test_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
       ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST(Facade, goes_from_text_to_a_verdict_and_its_reports) {
  const auto structure = load_text(kTwoModules, "pair");
  ASSERT_TRUE(structure) << structure.error().message;
  EXPECT_EQ(structure.value().name, "pair");
  const CheckResult result = check(structure.value());
  EXPECT_EQ(result.assessment.verdict, verdict::Verdict::kSafe);
  EXPECT_GT(result.seconds, 0);
  EXPECT_NE(report_json(structure.value(), result).find("\"verdict\": \"safe\""),
            std::string::npos);
  EXPECT_NE(report_text(structure.value(), result).find("2 existing, 0 planned"),
            std::string::npos);
  EXPECT_NE(picture_svg(structure.value(), result).find("</svg>"), std::string::npos);
  EXPECT_NE(picture_vtu(structure.value(), result).find("</VTKFile>"), std::string::npos);
}

TEST(Facade, describes_an_error_in_one_line) {
  const auto broken = load_text("{");
  ASSERT_FALSE(broken);
  const std::string line = describe(broken.error(), "robot.json");
  EXPECT_TRUE(line.starts_with("robot.json: line 1: ")) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

TEST_F(Files, are_read_back_as_written) {
  const fs::path path = folder_ / "pair.json";
  EXPECT_FALSE(write_file(path, kTwoModules));
  const auto text = read_file(path);
  ASSERT_TRUE(text);
  EXPECT_EQ(text.value(), kTwoModules);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "a temporary file is left";
  const auto structure = load_file(path);
  ASSERT_TRUE(structure);
  EXPECT_EQ(structure.value().name, "pair");
}

TEST_F(Files, that_are_folders_or_missing_are_refused) {
  EXPECT_EQ(load_file(folder_).error().code, base::ErrorCode::kUnreadable);
  EXPECT_EQ(load_file(folder_ / "missing").error().code, base::ErrorCode::kUnreadable);
  EXPECT_EQ(write_file(folder_, "text")->code, base::ErrorCode::kUnwritable);
  EXPECT_EQ(write_file(folder_ / "no" / "folder", "text")->code, base::ErrorCode::kUnwritable);
}

}  // namespace
}  // namespace holdfast
