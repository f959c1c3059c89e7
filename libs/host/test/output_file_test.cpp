// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// A file comes whole or not at all, in the place and with the rights of the one it replaces. What
// is expected is what POSIX says of rename, links and signals.
#include "holdfast/host/output_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace holdfast::host {
namespace {

namespace fs = std::filesystem;

class OutputFileTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "output_file_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }

  void TearDown() override { fs::remove_all(folder_); }

  fs::path place(const char* name) const { return folder_ / name; }

  static void put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

  static std::string text_of(const fs::path& path) {
    std::ifstream stream(path);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  std::size_t file_count() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  static std::optional<base::Error> write(const fs::path& path, const std::string& text) {
    auto opened = OutputFile::open(path);
    if (!opened) {
      return opened.error();
    }
    OutputFile file = std::move(opened).value();
    file.stream() << text;
    return file.finish();
  }

  fs::path folder_;
};

unsigned mode_of(const fs::path& path) {
  struct stat status {};

  return ::stat(path.c_str(), &status) == 0 ? status.st_mode & 07777U : 0;
}

TEST_F(OutputFileTest, a_new_file_has_the_rights_of_the_umask) {
  const mode_t old = ::umask(027);
  EXPECT_FALSE(write(place("new"), "text"));
  ::umask(old);
  EXPECT_EQ(text_of(place("new")), "text");
  EXPECT_EQ(mode_of(place("new")), 0640U);
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(OutputFileTest, a_file_that_is_replaced_keeps_its_rights) {
  for (const unsigned mode : {0600U, 0644U, 0775U}) {
    put(place("old"), "a longer text");
    ASSERT_EQ(::chmod(place("old").c_str(), mode), 0);
    EXPECT_FALSE(write(place("old"), "new"));
    EXPECT_EQ(text_of(place("old")), "new");
    EXPECT_EQ(mode_of(place("old")), mode);
  }
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(OutputFileTest, a_link_stays_and_what_it_leads_to_is_replaced) {
  fs::create_directory(place("elsewhere"));
  put(place("elsewhere") / "there", "old");
  fs::create_symlink("elsewhere/there", place("near"));
  fs::create_symlink("near", place("link"));
  EXPECT_FALSE(write(place("link"), "new"));
  EXPECT_TRUE(fs::is_symlink(place("link")) && fs::is_symlink(place("near")));
  EXPECT_EQ(text_of(place("elsewhere") / "there"), "new");
  // One that leads to nothing yet.
  fs::create_symlink("elsewhere/later", place("dangling"));
  EXPECT_FALSE(write(place("dangling"), "later"));
  EXPECT_TRUE(fs::is_symlink(place("dangling")));
  EXPECT_EQ(text_of(place("elsewhere") / "later"), "later");
  // One that leads to itself.
  fs::create_symlink("round", place("round"));
  EXPECT_EQ(write(place("round"), "text")->code, base::ErrorCode::kUnwritable);
}

TEST_F(OutputFileTest, further_names_of_a_file_stay_its_names) {
  put(place("one"), "a longer text");
  fs::create_hard_link(place("one"), place("two"));
  EXPECT_FALSE(write(place("two"), "new"));
  EXPECT_EQ(text_of(place("one")), "new");
  EXPECT_EQ(fs::hard_link_count(place("one")), 2U);
}

/// What is put over the beginning is longer than a buffer behind it.
TEST_F(OutputFileTest, a_file_can_be_sought_in_but_what_is_written_directly_cannot) {
  const std::string tail(200'000, 'x');
  auto file = OutputFile::open(place("file")).value();
  std::ostream& out = file.stream();
  out << "1234" << tail;
  EXPECT_EQ(out.tellp(), std::streamoff{200'004});
  out.seekp(1);
  EXPECT_EQ(out.tellp(), std::streamoff{1});
  out << "ab";
  out.seekp(200'004);
  out << "end";
  EXPECT_EQ(file.finish(), std::nullopt);
  EXPECT_EQ(text_of(place("file")), "1ab4" + tail + "end");

  auto device = OutputFile::open("/dev/null").value();
  EXPECT_EQ(device.stream().tellp(), std::streampos(-1));
}

TEST_F(OutputFileTest, an_unfinished_file_leaves_nothing_and_changes_nothing) {
  put(place("old"), "old");
  {
    auto opened = OutputFile::open(place("old"));
    ASSERT_TRUE(opened);
    OutputFile file = std::move(opened).value();
    file.stream() << "half of the new one" << std::flush;
    EXPECT_EQ(file_count(), 2U);
  }
  EXPECT_EQ(file_count(), 1U);
  EXPECT_EQ(text_of(place("old")), "old");
}

TEST_F(OutputFileTest, nothing_goes_through_a_link_that_somebody_laid) {
  put(place("victim"), "precious");
  for (const char* name : {"report.part", "report.tmp", ".report", "report~"}) {
    fs::create_symlink(place("victim"), place(name));
  }
  EXPECT_FALSE(write(place("report"), "text"));
  EXPECT_EQ(text_of(place("victim")), "precious");
  EXPECT_FALSE(fs::is_symlink(place("report")));
}

TEST_F(OutputFileTest, what_cannot_be_written_is_an_error) {
  EXPECT_NE(write("/dev/full", "text")->message.find("No space left"), std::string::npos);
  // More than any buffer holds.
  EXPECT_TRUE(write("/dev/full", std::string(1U << 20U, 'x')));
  EXPECT_FALSE(write("/dev/null", "text"));
  EXPECT_EQ(write(folder_, "text")->message,
            "expected the name of a file to write, found a folder");
  EXPECT_TRUE(write(place("no") / "folder", "text"));
  if (::geteuid() != 0) {  // The superuser may write what is not writable.
    put(place("mine"), "old");
    ::chmod(place("mine").c_str(), 0400);
    EXPECT_TRUE(write(place("mine"), "new"));
  }
}

TEST_F(OutputFileTest, a_signal_removes_unfinished_files) {
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      OutputFile::remove_unfinished_on_signals();
      auto first = OutputFile::open(place("first"));
      auto second = OutputFile::open(place("second"));
      const bool is_there = file_count() == 2;
      ::raise(is_there ? signal : SIGKILL);
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), signal);
    EXPECT_EQ(file_count(), 0U);
  }
}

}  // namespace
}  // namespace holdfast::host
