// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Whatever is written and wherever to: a file is what a text in memory would be, or it stays as it
// was. And pages of 2 MB change nothing that a program can see.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "holdfast/host/large_pages.hpp"
#include "holdfast/host/output_file.hpp"

namespace holdfast::host {
namespace {

namespace fs = std::filesystem;

class OutputFileProperties : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "output_property_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    path_ = folder_ / "file";
    std::ofstream(path_) << "old";
  }

  void TearDown() override { fs::remove_all(folder_); }

  std::string text() const {
    std::ifstream stream(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  /// The old text, and no temporary file beside it.
  bool is_as_it_was() const {
    return text() == "old" &&
           std::distance(fs::directory_iterator(folder_), fs::directory_iterator()) == 1;
  }

  fs::path folder_;
  fs::path path_;
};

/// Runs in a process of its own; true if `work` returned true there.
template <class Work>
bool is_true_in_child(const Work& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::_exit(work() ? 0 : 1);
  }
  int status = 0;
  return child > 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

/// One piece of text at a random place of what is there, in the stream and in memory.
void write_piece(std::ostream& out, std::string& expected, std::mt19937_64& random) {
  if (random() % 3 == 0) {
    const std::size_t place = random() % (expected.size() + 1);
    out.seekp(static_cast<std::streamoff>(place));
    ASSERT_EQ(out.tellp(), static_cast<std::streamoff>(place));
  }
  // Pieces are shorter and longer than the stream's buffer of 64 KB.
  const std::string piece(random() % (random() % 8 == 0 ? 200'000 : 3000),
                          static_cast<char>(random() % 256));
  const auto place = static_cast<std::size_t>(out.tellp());
  out << piece;
  expected.resize(std::max(expected.size(), place + piece.size()));
  expected.replace(place, piece.size(), piece);
}

TEST_F(OutputFileProperties, what_is_written_at_random_places_is_what_a_text_would_be) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    std::ofstream(path_) << "old";
    std::mt19937_64 random(seed);
    OutputFile file = OutputFile::open(path_).value();
    std::string expected;
    for (int i = 0; i < 30; ++i) {
      write_piece(file.stream(), expected, random);
    }
    EXPECT_EQ(text(), "old") << "before it is finished";
    ASSERT_EQ(file.finish(), std::nullopt);
    ASSERT_EQ(text(), expected) << seed;
  }
}

TEST_F(OutputFileProperties, a_file_that_grows_too_large_stays_as_it_was) {
  for (const std::size_t over : {1U, 70'000U, 1'000'000U}) {
    EXPECT_TRUE(is_true_in_child([&] {
      constexpr rlim_t kBytesMax = 100'000;
      const rlimit limit{.rlim_cur = kBytesMax, .rlim_max = kBytesMax};
      ::signal(SIGXFSZ, SIG_IGN);
      if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) {
        return false;
      }
      OutputFile file = OutputFile::open(path_).value();
      file.stream() << std::string(kBytesMax + over, 'x');
      const auto error = file.finish();
      return error && error->code == base::ErrorCode::kUnwritable &&
             error->message.find("File too large") != std::string::npos;
    }));
    EXPECT_TRUE(is_as_it_was()) << over;
  }
}

/// A stream does not take what comes after a move that failed.
TEST_F(OutputFileProperties, after_a_move_that_cannot_be_made_the_file_stays_as_it_was) {
  {
    OutputFile file = OutputFile::open(path_).value();
    file.stream() << "first";
    file.stream().seekp(-1);
    file.stream() << "second";
    EXPECT_TRUE(file.finish()) << "to before the beginning";
  }
  EXPECT_TRUE(is_as_it_was());
  {
    OutputFile file = OutputFile::open(path_).value();
    file.stream() << "first";
    file.stream().seekp(0, std::ios::end);
    file.stream() << "second";
    EXPECT_TRUE(file.finish()) << "from the end, which is not offered";
  }
  EXPECT_TRUE(is_as_it_was());
  OutputFile device = OutputFile::open("/dev/null").value();
  device.stream() << "first";
  device.stream().seekp(0);
  device.stream() << "second";
  EXPECT_TRUE(device.finish()) << "what goes out directly cannot be sought in";
}

/// Blocks of a few bytes to some megabytes, taken, stretched and freed in random order: what is
/// put into them stays.
bool is_memory_kept(std::mt19937_64& random) {
  std::vector<std::vector<std::uint8_t>> blocks(64);
  for (int i = 0; i < 2000; ++i) {
    const std::size_t index = random() % blocks.size();
    std::vector<std::uint8_t>& block = blocks[index];
    for (const std::uint8_t byte : block) {
      if (byte != index) {
        return false;
      }
    }
    block.resize(random() % (random() % 50 == 0 ? 4'000'000 : 5000), 0);
    block.shrink_to_fit();
    std::ranges::fill(block, static_cast<std::uint8_t>(index));
  }
  return true;
}

TEST(LargePages, leave_memory_as_it_is_when_asked_for_once_and_twice) {
  for (const int times : {1, 2}) {
    EXPECT_TRUE(is_true_in_child([&] {
      std::mt19937_64 random(4);
      std::vector<int> before(1000);
      std::iota(before.begin(), before.end(), 0);
      for (int i = 0; i < times; ++i) {
        use_large_pages();
      }
      const bool is_kept = is_memory_kept(random);
      return is_kept && std::accumulate(before.begin(), before.end(), 0) == 999 * 1000 / 2;
    })) << times;
  }
}

}  // namespace
}  // namespace holdfast::host
