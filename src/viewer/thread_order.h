// Which of the program's threads get the cores first: those that compute, before those that draw.
#pragma once
#include <vector>

namespace weft {

/// The threads of this program as they are now, ascending; empty where the system does not tell (it is not
/// Linux).
std::vector<int> threads_now();

/// From now on the threads that came since `before` stand behind the others where both want a core: their
/// nice value becomes kBehindNice. Where the system refuses, all stays as it is.
/// @return  how many
int put_behind(const std::vector<int>& before);

/// Three tenths of a core beside a thread that never rests. More would leave pictures to other programs'
/// mercy: at 10 one took half a second beside four busy neighbours.
constexpr int kBehindNice = 4;

}  // namespace weft
