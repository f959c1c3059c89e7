// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Motions are read as docs/formats.md has them: the document's own example gives the motions of
// cubes that pivot; what is wrong is said with its place.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "holdfast/io/move_report.hpp"

namespace holdfast::io {
namespace {

std::string fault_of(const std::string& members) {
  const auto read =
      read_motions(R"({"format": "holdfast-motions", "version": 1, )" + members + "}");
  return read ? "" : read.error().where + " " + read.error().message;
}

TEST(MotionsFile, reads_the_example_of_the_document) {
  std::ostringstream text;
  text << std::ifstream(HOLDFAST_DOCUMENT_DIR "/formats.md").rdbuf();
  const std::string document = text.str();
  const std::size_t first = document.find(R"({"format": "holdfast-motions")");
  ASSERT_NE(first, std::string::npos);
  const auto read = read_motions(document.substr(first, document.find("```", first) - first));
  ASSERT_TRUE(read) << read.error().message;
  const plan::Motions& pivoting = *plan::pivoting_cubes();
  EXPECT_EQ(read.value().name, pivoting.name);
  ASSERT_EQ(read.value().motions.size(), pivoting.motions.size());
  for (std::size_t i = 0; i < pivoting.motions.size(); ++i) {
    EXPECT_EQ(read.value().motions[i].name, pivoting.motions[i].name);
    EXPECT_EQ(read.value().motions[i].to, pivoting.motions[i].to);
    EXPECT_EQ(read.value().motions[i].modules, pivoting.motions[i].modules);
    EXPECT_EQ(read.value().motions[i].free, pivoting.motions[i].free);
  }
}

TEST(MotionsFile, takes_cells_of_a_lattice_as_files_have_them) {
  const auto read = read_motions(
      R"({"format": "holdfast-motions", "version": 1, "lattice": "catoms3D", "images": "none",
          "motions": [{"to": [1, 0, 0], "modules": [[0, 0, -1]], "free": [[0, 0, -2]]}]})");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read.value().lattice, base::kFaceCentred);
  ASSERT_EQ(read.value().motions.size(), 1U);
  const plan::Motion& motion = read.value().motions[0];
  EXPECT_EQ(motion.modules[0], base::axial_of(base::kFaceCentred, {0, 0, -1}));
  EXPECT_EQ(motion.free[0], base::axial_of(base::kFaceCentred, {0, 0, -2}));
  EXPECT_NE(motion.free[0], (base::Cell{0, 0, -2}));
}

TEST(MotionsFile, may_only_bar_places_between_opposing_modules) {
  const auto read =
      read_motions(R"({"format": "holdfast-motions", "version": 1, "between_opposing": false})");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_FALSE(read.value().goes_between);
  EXPECT_TRUE(read.value().motions.empty());
}

TEST(MotionsFile, says_what_is_wrong_and_where) {
  EXPECT_EQ(read_motions("[]").error().message.substr(0, 8), "expected");
  EXPECT_NE(fault_of(R"("name": "none")").find("/motions expected at least one motion"),
            std::string::npos);
  EXPECT_NE(fault_of(R"("between_opposing": false, "motions": [])").find("at least one motion"),
            std::string::npos);
  EXPECT_NE(fault_of(R"("motions": [{"modules": [[0, 0, 1]]}])").find("/motions/0"),
            std::string::npos);
  EXPECT_NE(
      fault_of(R"("motions": [{"to": [1, 0], "modules": [[0, 0, 1]]}])").find("/motions/0/to"),
      std::string::npos);
  EXPECT_NE(fault_of(R"("motions": [{"to": [1, 0, 0], "modules": [], "free": []}])")
                .find("expected at least one module that it goes along"),
            std::string::npos);
  EXPECT_NE(fault_of(R"("lattice": "hexagon", "motions": [])").find("/lattice"), std::string::npos);
  EXPECT_NE(fault_of(R"("images": "all", "motions": [])").find("/images"), std::string::npos);
  EXPECT_NE(fault_of(R"("motion": [])").find("/motion"), std::string::npos);
}

}  // namespace
}  // namespace holdfast::io
