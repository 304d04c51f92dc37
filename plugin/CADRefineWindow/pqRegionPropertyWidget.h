#ifndef pqRegionPropertyWidget_h
#define pqRegionPropertyWidget_h

#include <pqInteractivePropertyWidget.h>

#include <array>

class pqDoubleLineEdit;

/// A region of the form xmin xmax ymin ymax zmin zmax: six fields in the panel, and a box in the
/// view whose faces are dragged. For a property group with the function Region (these six numbers)
/// of a filter, whose Input has the bounds that the button takes.
///
/// Of a region without thickness, such as that of a mesh in the plane, the box is drawn with a
/// thickness, and dragging it leaves that direction as it is.
class pqRegionPropertyWidget : public pqInteractivePropertyWidget
{
  Q_OBJECT

public:
  pqRegionPropertyWidget(vtkSMProxy* proxy, vtkSMPropertyGroup* group, QWidget* parent = nullptr);
  ~pqRegionPropertyWidget() override;

protected:
  void placeWidget() override;

private:
  using Bounds = std::array<double, 6>;

  void makeFields(vtkSMProperty* region);
  Bounds bounds() const;
  void setBounds(const Bounds& bounds);
  void takeBox();
  void takeDataBounds();

  std::array<pqDoubleLineEdit*, 6> fields_{};
  bool dragging_ = false; ///< The fields follow the box, and not the other way round.
};

#endif
