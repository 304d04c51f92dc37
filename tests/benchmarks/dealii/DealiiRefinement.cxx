// deal.II's uniform refinement of a box of hexahedra: dealii_refinement EDGES prints a JSON object
// with the cells made and the processor time of the fastest of a few runs.

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <limits>

int main(int count, char** arguments)
{
  if (count != 2)
  {
    std::cerr << "usage: dealii_refinement EDGES\n";
    return 1;
  }
  constexpr int repetitions = 3;
  double seconds = std::numeric_limits<double>::infinity();
  std::size_t made = 0;
  for (int k = 0; k < repetitions; ++k)
  {
    dealii::Triangulation<3> mesh;
    dealii::GridGenerator::subdivided_hyper_cube(
      mesh, static_cast<unsigned>(std::atoi(arguments[1])));
    const std::clock_t start = std::clock();
    mesh.refine_global(1);
    seconds = std::min(seconds, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    made = mesh.n_active_cells();
  }
  std::cout << "{\"made\": " << made << ", \"seconds\": " << seconds << "}\n";
}
