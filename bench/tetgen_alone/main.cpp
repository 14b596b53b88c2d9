// The peer of tetrahedralize/*: TetGen alone, in this process, on a clean surface.
//   pith-bench-tetgen SURFACE.off MAX_VOLUME RADIUS_EDGE   →   its last line is "result TETS SECONDS"
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <tetgen.h>

int main(int count, char** arguments) {
  if (count != 4) return 2;
  tetgenio in, out;
  if (!in.load_off(arguments[1])) return 1;
  char switches[] = "pYQq1.4a1"; // as pith asks for it
  tetgenbehavior behavior;
  if (!behavior.parse_commandline(switches)) return 1;
  behavior.maxvolume = std::atof(arguments[2]);
  behavior.minratio = std::atof(arguments[3]);
  const auto begin = std::chrono::steady_clock::now();
  try {
    tetrahedralize(&behavior, &in, &out);
  } catch (...) {
    return 1;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::printf("\nresult %d %.6f\n", out.numberoftetrahedra, seconds);
  return 0;
}
