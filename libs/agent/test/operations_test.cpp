// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The table of operations against docs/wire.md: its names, in its order, and how often an order
// exchanges, from the column "exchanges" there.
#include "holdfast/agent/wire/operations.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "holdfast/agent/messages/order.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

constexpr std::uint16_t kDegree = 7;

/// Counts before the report, then behind it.
struct Counts {
  int before = 0;
  int behind = 0;

  friend bool operator==(const Counts&, const Counts&) = default;
};

Counts counts_of(Operation operation, std::uint8_t flags = 0, std::uint16_t count = kDegree) {
  const Order order = {.operation = operation, .flags = flags, .count = count};
  const int behind = exchanges_behind(order);
  return {exchange_count(order) - behind, behind};
}

TEST(Operations, exchange_as_often_as_the_document_says) {
  EXPECT_EQ(counts_of(Operation::kBegin), (Counts{0, kDegree}));
  EXPECT_EQ(counts_of(Operation::kBegin, kOneSweep, 0), Counts{});
  EXPECT_EQ(counts_of(Operation::kIterate), (Counts{2, kDegree}));
  EXPECT_EQ(counts_of(Operation::kIterate, kWithClusters | kRestart), (Counts{2, 2 * kDegree + 2}));
  EXPECT_EQ(counts_of(Operation::kTreeIterate, 0, 0), (Counts{2, 0}));
  EXPECT_EQ(counts_of(Operation::kClusters), (Counts{1, kDegree}));
  EXPECT_EQ(counts_of(Operation::kResume), (Counts{2, kDegree}));
  EXPECT_EQ(counts_of(Operation::kResumeDeflated), (Counts{2 + 4, kDegree}));
  EXPECT_EQ(counts_of(Operation::kIterateDeflated, kRestart), (Counts{2, kDegree}));
  EXPECT_EQ(counts_of(Operation::kIterateLast, kKeepStates), (Counts{2, kDegree}));
  EXPECT_EQ(counts_of(Operation::kIterateLast, 0, 0), (Counts{2, 0}));
}

TEST(Operations, exchange_nothing_where_the_document_has_a_dash) {
  for (const Operation operation :
       {Operation::kPlan, Operation::kHosts, Operation::kMass, Operation::kAngles, Operation::kHold,
        Operation::kCorners, Operation::kLoads, Operation::kVerdict, Operation::kFactor,
        Operation::kForget, Operation::kRenew, Operation::kClose, Operation::kWord,
        Operation::kStage, Operation::kShape, Operation::kNext, Operation::kSeek,
        Operation::kBend}) {
    EXPECT_EQ(counts_of(operation, 0xff), Counts{}) << info(operation).name;
  }
}

TEST(Operations, have_the_names_of_the_document) {
  std::ifstream file(HOLDFAST_WIRE_DOCUMENT);
  ASSERT_TRUE(file.is_open()) << HOLDFAST_WIRE_DOCUMENT;
  std::stringstream text;
  text << file.rdbuf();
  for (const OperationInfo& row : kOperations) {
    const std::string start =
        "\n| " + std::to_string(static_cast<int>(row.operation)) + " " + row.name + " |";
    EXPECT_NE(text.str().find(start), std::string::npos) << start;
  }
}

}  // namespace
}  // namespace holdfast::agent
