#include "tests/bench/parts/default_vtu.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace qtet::bench {

Result<DefaultVtu> defaultVtu(const std::filesystem::path& path) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path.c_str());
  if (reader->CanReadFile(path.c_str()) == 0)
    return fail(ErrorCode::kBadInput, path.string() + " is no .vtu that VTK reads");
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  DefaultVtu out;
  out.cells = static_cast<std::uint64_t>(grid->GetNumberOfCells());
  grid->GetCellData()->Initialize();
  vtkPointData* fields = grid->GetPointData();
  while (fields->GetNumberOfArrays() > 1) fields->RemoveArray(fields->GetNumberOfArrays() - 1);
  if (fields->GetNumberOfArrays() == 1) out.field = fields->GetArrayName(0);
  // Filters and meshers make 64-bit ids; the reader keeps those of the file.
  grid->GetCells()->ConvertTo64BitStorage();

  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->WriteToOutputStringOn();
  writer->Write();
  out.bytes = writer->GetOutputString().size();
  return out;
}

}  // namespace qtet::bench
