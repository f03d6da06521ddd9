// Ctrl-C: the first one asks the running command to stop after the frame at hand; a second one ends at once.
#pragma once

namespace weft::cli {

/// Takes SIGINT, SIGTERM and SIGHUP (but under nohup). Until `stop_between_frames`, each ends the program at
/// once with exit code 130.
void catch_interrupts();

/// From now on the first signal only sets the flag that `interrupted` reads: the command has files to tidy.
void stop_between_frames();

bool interrupted();

}  // namespace weft::cli
