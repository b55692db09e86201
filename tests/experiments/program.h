// The real program as a child process.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

extern char** environ;

namespace halfslope {

inline const std::string kProgram = HALFSLOPE_BINARY_DIR "/halfslope";

/// How a child ended: its exit code, or 128 + the signal that killed it; what it said; how long it took.
struct Ended {
  int code = -1;
  std::string out, err;
  double seconds = 0;
};

struct ChildOptions {
  std::map<std::string, std::string> environment = {};  ///< beside what we have ourselves
  std::string out_path = {};  ///< where stdout goes instead of Ended::out, e.g. /dev/full; "closed" closes it
  std::string err_path = {};  ///< likewise
  std::optional<rlim_t> largest_file = {};   ///< RLIMIT_FSIZE
  std::optional<rlim_t> address_space = {};  ///< RLIMIT_AS
  std::vector<std::string> launcher = {};    ///< put before the program: an emulator and its flags
  std::string program = kProgram;
};

/// Started by the constructor; killed by the destructor unless waited for.
class Child {
 public:
  Child(const std::vector<std::string>& arguments, const ChildOptions& options = {})
      : out_(::memfd_create("out", MFD_CLOEXEC)),
        err_(::memfd_create("err", MFD_CLOEXEC)),
        start_(std::chrono::steady_clock::now()) {
    std::vector<std::string> command = options.launcher, variables;
    command.push_back(options.program);
    command.insert(command.end(), arguments.begin(), arguments.end());
    for (const auto& [name, value] : options.environment) variables.push_back(name + "=" + value);
    for (char** entry = environ; *entry; ++entry) {
      const std::string text = *entry;
      if (!options.environment.contains(text.substr(0, text.find('=')))) variables.push_back(text);
    }
    const auto pointers = [](std::vector<std::string>& strings) {
      std::vector<char*> list;
      for (std::string& text : strings) list.push_back(text.data());
      list.push_back(nullptr);
      return list;
    };
    const auto argv = pointers(command), envp = pointers(variables);
    process_ = ::fork();
    if (process_ < 0) throw std::runtime_error("fork failed");
    if (process_ > 0) return;
    // From here on only what a signal handler may do: this process may have had threads.
    if (options.largest_file) {
      const rlimit limit = {*options.largest_file, *options.largest_file};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    if (options.address_space) {
      const rlimit limit = {*options.address_space, *options.address_space};
      ::setrlimit(RLIMIT_AS, &limit);
    }
    ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
    redirect(STDOUT_FILENO, options.out_path, out_);
    redirect(STDERR_FILENO, options.err_path, err_);
    ::execve(argv[0], argv.data(), envp.data());
    ::_exit(127);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (process_ > 0) {
      signal(SIGKILL);
      wait();
    }
    ::close(out_);
    ::close(err_);
  }

  void signal(int number) const { ::kill(process_, number); }
  bool running() {
    siginfo_t info = {};
    return ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0;
  }
  Ended wait() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = 0;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(out_), text_of(err_),
            elapsed.count()};
  }

 private:
  static void redirect(int stream, const std::string& path, int otherwise) {
    if (path == "closed") {
      ::close(stream);
    } else {
      ::dup2(path.empty() ? otherwise : ::open(path.c_str(), O_WRONLY | O_CLOEXEC), stream);
    }
  }
  static std::string text_of(int file) {
    std::string text(static_cast<std::size_t>(::lseek(file, 0, SEEK_END)), '\0');
    const ssize_t got = ::pread(file, text.data(), text.size(), 0);
    text.resize(static_cast<std::size_t>(got));
    return text;
  }

  int out_, err_;
  std::chrono::steady_clock::time_point start_;
  pid_t process_ = 0;
};

inline Ended run_program(const std::vector<std::string>& arguments, const ChildOptions& options = {}) {
  return Child(arguments, options).wait();
}

}  // namespace halfslope
