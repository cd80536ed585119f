#include "simplify/read/vtk/vtk_readers.h"

#include <vtkAVSucdReader.h>
#include <vtkCGNSReader.h>
#include <vtkDataSetReader.h>
#include <vtkExodusIIReader.h>
#include <vtkFLUENTReader.h>
#include <vtkHDFReader.h>
#include <vtkMultiBlockPLOT3DReader.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "simplify/read/vtk/fast_xml_parser.h"

namespace qtet {
namespace {

template <class Reader>
vtkSmartPointer<vtkAlgorithm> xmlReader(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<FastXmlReader<Reader>>::New();
  reader->SetFileName(path.c_str());
  return reader;
}

vtkSmartPointer<vtkAlgorithm> legacyReader(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<vtkDataSetReader>::New();
  reader->SetFileName(path.c_str());
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllNormalsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllTCoordsOn();
  reader->ReadAllFieldsOn();
  return reader;
}

/// Without global ids: VTK 9.1 crashes where it is to give them for all points of a block.
vtkSmartPointer<vtkAlgorithm> exodusReader(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<vtkExodusIIReader>::New();
  reader->SetFileName(path.c_str());
  reader->SetSqueezePoints(false);  // every block has all points, so that blocks hang together
  reader->ApplyDisplacementsOff();  // the mesh is one over all steps
  reader->GenerateGlobalElementIdArrayOff();
  reader->GenerateGlobalNodeIdArrayOff();
  reader->UpdateInformation();
  reader->SetAllArrayStatus(vtkExodusIIReader::NODAL, 1);
  reader->SetAllArrayStatus(vtkExodusIIReader::ELEM_BLOCK, 1);
  return reader;
}

vtkSmartPointer<vtkAlgorithm> cgnsReader(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<vtkCGNSReader>::New();
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  reader->EnableAllBases();
  reader->EnableAllPointArrays();
  reader->EnableAllCellArrays();
  return reader;
}

vtkSmartPointer<vtkAlgorithm> fluentReader(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<vtkFLUENTReader>::New();
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  reader->EnableAllCellArrays();
  return reader;
}

vtkSmartPointer<vtkAlgorithm> hdfReader(const std::filesystem::path& path) {
  const auto reader = vtkSmartPointer<vtkHDFReader>::New();
  reader->SetFileName(path.c_str());
  return reader;
}

vtkSmartPointer<vtkAlgorithm> plot3dReader(const std::filesystem::path& path,
                                           const std::string& solution) {
  // of vtkMultiBlockPLOT3DReader's functions, beside density, momentum and energy
  constexpr int kPressure = 110, kVelocity = 200;
  const auto reader = vtkSmartPointer<vtkMultiBlockPLOT3DReader>::New();
  reader->SetXYZFileName(path.c_str());
  reader->AutoDetectFormatOn();
  if (!solution.empty()) {
    reader->SetQFileName(solution.c_str());
    reader->AddFunction(kPressure);
    reader->AddFunction(kVelocity);
  }
  return reader;
}

}  // namespace

vtkSmartPointer<vtkAlgorithm> vtkReaderOf(const std::filesystem::path& path, MeshFormat format,
                                          const ReadOptions& options) {
  switch (format) {
    // our own reader takes all .vtu files but the rare ones that hold several steps
    case MeshFormat::kVtu: return xmlReader<vtkXMLUnstructuredGridReader>(path);
    case MeshFormat::kVts: return xmlReader<vtkXMLStructuredGridReader>(path);
    case MeshFormat::kVtr: return xmlReader<vtkXMLRectilinearGridReader>(path);
    case MeshFormat::kVti: return xmlReader<vtkXMLImageDataReader>(path);
    case MeshFormat::kLegacyVtk: return legacyReader(path);
    case MeshFormat::kExodus: return exodusReader(path);
    case MeshFormat::kCgns: return cgnsReader(path);
    case MeshFormat::kFluent: return fluentReader(path);
    case MeshFormat::kVtkHdf: return hdfReader(path);
    case MeshFormat::kPlot3d: return plot3dReader(path, options.plot3dSolution);
    default: {
      const auto reader = vtkSmartPointer<vtkAVSucdReader>::New();
      reader->SetFileName(path.c_str());
      return reader;
    }
  }
}

}  // namespace qtet
