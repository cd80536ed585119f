// VTK's parser of its XML files (.vtu and its kin) with quicker ways through base64 and zlib, on
// which VTK spends most of its time (tests/bench/TABLE.md).
#pragma once

#include <vtkBitArray.h>
#include <vtkDataArray.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>
#include <vtkXMLUnstructuredDataReader.h>

#include <cstring>
#include <string>
#include <type_traits>

namespace qtet {

/// A new parser, which the caller owns. It reads what vtkXMLDataParser reads, to the byte, and
/// fails where that fails. It also fails where base64 ends within an array, which VTK passes over.
/// And it fails where the sizes of compressed blocks contradict each other, which VTK does not
/// survive.
[[nodiscard]] vtkXMLDataParser* newFastXmlParser();

/// The fault of the text of the array that the parser has read last. Either it holds other than
/// `told` numbers, or something else stands behind them. Empty: nothing. REQUIRES: a parser of
/// newFastXmlParser; `array` was read last, and is text.
[[nodiscard]] std::string faultOfTextArray(vtkXMLDataParser& parser, vtkXMLDataElement& array,
                                           vtkIdType told);

/// One of VTK's XML readers, with that parser. An unstructured array that is text must hold as many
/// numbers as the file's counts tell: VTK passes over those that are too many.
template <class Reader>
class FastXmlReader : public Reader {
 public:
  static FastXmlReader* New() {
    auto* reader = new FastXmlReader;
    reader->InitializeObjectBase();
    return reader;
  }
  FastXmlReader(const FastXmlReader&) = delete;
  FastXmlReader& operator=(const FastXmlReader&) = delete;

 protected:
  FastXmlReader() = default;
  ~FastXmlReader() override = default;
  void CreateXMLParser() override {
    if (this->XMLParser) this->DestroyXMLParser();
    this->XMLParser = newFastXmlParser();
  }
  int ReadArrayValues(vtkXMLDataElement* element, vtkIdType arrayIndex, vtkAbstractArray* array,
                      vtkIdType startIndex, vtkIdType told, vtkXMLReader::FieldType type) override {
    const int done = Reader::ReadArrayValues(element, arrayIndex, array, startIndex, told, type);
    // a structured array may be read in parts
    if constexpr (std::is_base_of_v<vtkXMLUnstructuredDataReader, Reader>) {
      const char* format = element->GetAttribute("format");
      // VTK counts bits in bytes, and has no numbers for texts
      const bool countable = vtkDataArray::SafeDownCast(array) && !vtkBitArray::SafeDownCast(array);
      const bool isText =
          !element->GetAttribute("offset") && (!format || std::strcmp(format, "binary") != 0);
      if (!countable || !isText) return done;
      const std::string fault = faultOfTextArray(*this->XMLParser, *element, told);
      if (fault.empty()) return done;
      vtkErrorMacro(<< fault);
      return 0;
    }
    return done;
  }
};

}  // namespace qtet
