// Prints the point of a CAD file that is nearest to a given one: closest_point FILE X Y Z.
#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/CADFile.h>

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv)
{
  if (argc != 5)
  {
    std::fprintf(stderr, "usage: closest_point FILE X Y Z\n");
    return EXIT_FAILURE;
  }
  try
  {
    const auto model = cadrefine::readCADFile(argv[1]);
    std::printf("%d faces, %d edges, %d vertices, unit %s\n", model->count(2), model->count(1),
      model->count(0), model->unit().c_str());
    const cadrefine::Point3 point{ std::atof(argv[2]), std::atof(argv[3]), std::atof(argv[4]) };
    const cadrefine::ClosestPoint nearest = model->nearest(point);
    std::printf("nearest point %.12g %.12g %.12g, distance %.12g, on entity %d of dimension %d\n",
      nearest.point[0], nearest.point[1], nearest.point[2], nearest.distance, nearest.entity.index,
      nearest.entity.dimension);
  }
  catch (const cadrefine::Error& error)
  {
    std::fprintf(stderr, "closest_point: %s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
