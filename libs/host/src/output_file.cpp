// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/host/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <random>
#include <streambuf>
#include <string>
#include <system_error>
#include <utility>

#include "unfinished_files.hpp"

namespace holdfast::host {
namespace {

namespace fs = std::filesystem;

/// The number of symbolic links that are followed, which is also the kernel's.
constexpr int kLinkCountMax = 40;

/// The number of names that are tried: that more are taken is no accident.
constexpr int kNameTrialMax = 16;

base::Error unwritable(int error) {
  return {.code = base::ErrorCode::kUnwritable,
          .message = "cannot be written: " + std::generic_category().message(error)};
}

/// The number of an open descriptor by its link in /proc; -1 if the path is none of this process.
int descriptor_number(const fs::path& path) {
  std::error_code code;
  const fs::path folder = fs::canonical(path.parent_path(), code);
  const std::string name = path.filename().string();
  int number = -1;
  const auto [end, fault] = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool is_number = fault == std::errc() && end == name.data() + name.size() && number >= 0;
  const std::string own = "/proc/" + std::to_string(getpid());
  const bool is_own = folder == own + "/fd" || folder.string().starts_with(own + "/task/");
  return !code && is_number && is_own && folder.filename() == "fd" ? number : -1;
}

/// Writes into a descriptor and remembers the first failure.
class DescriptorBuffer : public std::streambuf {
 public:
  DescriptorBuffer(int descriptor, bool is_seekable)
      : descriptor_(descriptor), is_seekable_(is_seekable) {
    setp(text_.data(), text_.data() + text_.size());
  }

  int error() const { return error_; }

 protected:
  int_type overflow(int_type next) override {
    if (sync() != 0) {
      return traits_type::eof();
    }
    if (!traits_type::eq_int_type(next, traits_type::eof())) {
      sputc(traits_type::to_char_type(next));
    }
    return traits_type::not_eof(next);
  }

  int sync() override {
    const char* from = pbase();
    position_ += pptr() - pbase();
    while (from < pptr() && error_ == 0) {
      const ssize_t written = ::write(descriptor_, from, static_cast<std::size_t>(pptr() - from));
      if (written >= 0) {
        from += written;
      } else if (errno != EINTR) {
        error_ = errno;
      }
    }
    setp(text_.data(), text_.data() + text_.size());
    return error_ == 0 ? 0 : -1;
  }

  /// Tells the position; moves go through seekpos().
  pos_type seekoff(off_type offset, std::ios_base::seekdir from,
                   std::ios_base::openmode /*which*/) override {
    const bool tells = offset == 0 && from == std::ios_base::cur;
    return tells && is_seekable_ ? pos_type(position_ + (pptr() - pbase())) : pos_type(-1);
  }

  pos_type seekpos(pos_type position, std::ios_base::openmode /*which*/) override {
    if (!is_seekable_ || sync() != 0) {
      return {-1};
    }
    if (::lseek(descriptor_, position, SEEK_SET) < 0) {
      error_ = errno;
      return {-1};
    }
    position_ = position;
    return position;
  }

 private:
  int descriptor_;
  bool is_seekable_;
  int error_ = 0;
  off_type position_ = 0;  ///< In the file, where the text begins.
  std::array<char, 1U << 16U> text_;
};

/// A name that nobody can foresee, in the folder of the target.
std::string random_name(const fs::path& target) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device device;
  std::uniform_int_distribution<std::size_t> letter(0, kLetters.size() - 1);
  std::string name = ".holdfast-";
  for (int i = 0; i < 16; ++i) {
    name += kLetters[letter(device)];
  }
  return (target.parent_path() / name).string();
}

}  // namespace

/// The descriptor, and the temporary file behind it if there is one.
class OutputFile::Writer {
 public:
  Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  ~Writer() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
    discard();
  }

  /// These functions return the number of an error, 0 for none.
  int open_copy(int descriptor) {
    std::fflush(stdout);
    return start(::fcntl(descriptor, F_DUPFD_CLOEXEC, 0), false);
  }

  int open_directly(const fs::path& target, bool is_file) {
    return start(::open(target.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | (is_file ? O_TRUNC : 0)),
                 is_file);
  }

  /// Opens a file beside the target; `old` is what stands there already, nullptr for nothing.
  int open_temporary(const fs::path& target, const struct stat* old) {
    target_ = target;
    int error = EEXIST;
    for (int trial = 0; trial < kNameTrialMax && error == EEXIST; ++trial) {
      name_ = random_name(target);
      // Known before it exists: no signal can come in between.
      slot_ = unfinished_files::add(name_);
      const int descriptor = ::open(
          name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, old ? 0600 : 0666);
      if (descriptor >= 0) {
        return old == nullptr ? start(descriptor, true) : start_like(descriptor, *old);
      }
      error = errno;
      forget();
    }
    return error;
  }

  std::ostream& stream() { return stream_; }

  int finish() {
    stream_.flush();
    int error = buffer_ ? buffer_->error() : EBADF;
    if (error == 0 && stream_.fail()) {
      error = EIO;  // By a move that cannot be made; what came behind it was not written.
    }
    // Some file systems tell only now that the disk is full.
    if (::close(std::exchange(descriptor_, -1)) != 0 && error == 0) {
      error = errno;
    }
    if (error == 0 && !name_.empty()) {
      error = ::rename(name_.c_str(), target_.c_str()) == 0 ? 0 : errno;
      if (error == 0) {
        forget();
      }
    }
    discard();
    return error;
  }

 private:
  int start(int descriptor, bool is_seekable) {
    if (descriptor < 0) {
      return errno;
    }
    descriptor_ = descriptor;
    buffer_ = std::make_unique<DescriptorBuffer>(descriptor, is_seekable);
    stream_.rdbuf(buffer_.get());
    return 0;
  }

  /// Starts with another file's permission bits and, if that is allowed, its owner.
  int start_like(int descriptor, const struct stat& old) {
    [[maybe_unused]] const int is_not_owned = ::fchown(descriptor, old.st_uid, old.st_gid);
    const int error = ::fchmod(descriptor, old.st_mode & 07777U) == 0 ? 0 : errno;
    const int start_error = start(descriptor, true);
    return error != 0 ? error : start_error;
  }

  void forget() {
    unfinished_files::remove(slot_);
    name_.clear();
  }

  void discard() {
    if (!name_.empty()) {
      ::unlink(name_.c_str());
      forget();
    }
  }

  int descriptor_ = -1;
  fs::path target_;
  std::string name_;  ///< Of the temporary file; empty if there is none.
  int slot_ = -1;
  std::unique_ptr<DescriptorBuffer> buffer_;
  std::ostream stream_{nullptr};
};

OutputFile::OutputFile(std::unique_ptr<Writer> writer) : writer_(std::move(writer)) {}

OutputFile::OutputFile(OutputFile&& other) noexcept = default;
OutputFile::~OutputFile() = default;

std::ostream& OutputFile::stream() { return writer_->stream(); }

std::optional<base::Error> OutputFile::finish() {
  const int error = writer_->finish();
  return error == 0 ? std::nullopt : std::optional(unwritable(error));
}

fs::path OutputFile::target(const fs::path& path) {
  std::error_code code;
  fs::path end = path;
  for (int i = 0; i < kLinkCountMax && !is_descriptor(end); ++i) {
    const fs::path next = fs::read_symlink(end, code);
    if (code) {
      break;  // Not a link.
    }
    end = next.is_absolute() ? next : end.parent_path() / next;
  }
  return end;
}

bool OutputFile::is_descriptor(const fs::path& target) { return descriptor_number(target) >= 0; }

void OutputFile::remove_unfinished_on_signals() { unfinished_files::watch_signals(); }

base::Result<OutputFile> OutputFile::open(const fs::path& path) {
  auto writer = std::make_unique<Writer>();
  const fs::path end = target(path);
  const int descriptor = path == "-" ? STDOUT_FILENO : descriptor_number(end);

  struct stat status {};

  int error = 0;
  if (descriptor >= 0) {
    error = writer->open_copy(descriptor);
  } else if (::stat(end.c_str(), &status) != 0) {
    error = errno == ENOENT ? writer->open_temporary(end, nullptr) : errno;
  } else if (S_ISDIR(status.st_mode)) {
    return base::Error{.code = base::ErrorCode::kUnwritable,
                       .message = "expected the name of a file to write, found a folder"};
  } else if (!S_ISREG(status.st_mode) || status.st_nlink > 1) {
    error = writer->open_directly(end, S_ISREG(status.st_mode));
  } else if (::access(end.c_str(), W_OK) != 0) {
    error = errno;  // Who may write the folder only should not replace its files.
  } else {
    error = writer->open_temporary(end, &status);
  }
  if (error != 0) {
    return unwritable(error);
  }
  return OutputFile(std::move(writer));
}

}  // namespace holdfast::host
