// Adapts a mesh to its CAD: adapt MESH.vtu CAD STEPS OUTPUT.vtu.
#include <vtkAdaptToCAD.h>
#include <vtkCADReader.h>

#include <vtkNew.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cstdlib>
#include <iostream>

int main(int argc, char** argv)
{
  if (argc != 5)
  {
    std::cerr << "usage: adapt MESH.vtu CAD STEPS OUTPUT.vtu\n";
    return EXIT_FAILURE;
  }
  vtkNew<vtkXMLUnstructuredGridReader> mesh;
  mesh->SetFileName(argv[1]);
  vtkNew<vtkCADReader> cad;
  cad->SetFileName(argv[2]);

  vtkNew<vtkAdaptToCAD> adapt;
  adapt->SetInputConnection(mesh->GetOutputPort());
  adapt->SetCADConnection(cad->GetOutputPort());
  adapt->SetMaximumSteps(std::atoi(argv[3]));
  adapt->SetErrorMarking(vtkAdaptToCAD::BULK);
  adapt->Update();
  if (adapt->GetOutput()->GetNumberOfCells() == 0) // VTK has told the reason
  {
    return EXIT_FAILURE;
  }
  vtkTable::SafeDownCast(adapt->GetOutputDataObject(1))->Dump(14);

  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputConnection(adapt->GetOutputPort());
  writer->SetFileName(argv[4]);
  writer->SetDataModeToBinary(); // VTK's default, appended data, is not what every program reads
  return writer->Write() == 1 ? EXIT_SUCCESS : EXIT_FAILURE;
}
