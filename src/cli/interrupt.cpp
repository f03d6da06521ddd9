// Signal handling with nothing but what a handler may touch: a flag and _exit.
#include "cli/interrupt.h"

#include <unistd.h>

#include <csignal>

#include "core/error.h"

namespace weft::cli {
namespace {

volatile std::sig_atomic_t graceful = 0;
volatile std::sig_atomic_t signalled = 0;

extern "C" void on_signal(int) {
  if (!graceful || signalled) _exit(static_cast<int>(Exit::interrupted));
  signalled = 1;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};  // nohup's choice stands; a closed terminal is an interruption
  if (sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
    sigaction(SIGHUP, &action, nullptr);
}

void stop_between_frames() { graceful = 1; }

bool interrupted() { return signalled != 0; }

}  // namespace weft::cli
