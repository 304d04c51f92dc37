#include "pqRegionPropertyWidget.h"

#include <QCheckBox>
#include <QGridLayout>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <pqDoubleLineEdit.h>
#include <vtkBoundingBox.h>
#include <vtkSMNewWidgetRepresentationProxy.h>
#include <vtkSMPropertyGroup.h>
#include <vtkSMPropertyHelper.h>

#include <algorithm>
#include <cmath>

namespace
{

using Bounds = std::array<double, 6>;

bool isFlat(const Bounds& bounds, int axis)
{
  return !(bounds[2 * axis] < bounds[2 * axis + 1]);
}

/// What is drawn of a region: directions without thickness get one, a fiftieth of its diagonal on
/// either side.
Bounds drawn(Bounds bounds)
{
  double squares = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = bounds[2 * axis + 1] - bounds[2 * axis];
    squares += length > 0 ? length * length : 0;
  }
  const double margin = squares > 0 ? std::sqrt(squares) / 50 : 0.5;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (isFlat(bounds, axis))
    {
      bounds[2 * axis + 1] = bounds[2 * axis] + margin;
      bounds[2 * axis] -= margin;
    }
  }
  return bounds;
}

} // namespace

pqRegionPropertyWidget::pqRegionPropertyWidget(
  vtkSMProxy* proxy, vtkSMPropertyGroup* group, QWidget* parent)
  : pqInteractivePropertyWidget("representations", "BoxWidgetRepresentation", proxy, group, parent)
{
  vtkSMProxy* box = widgetProxy();
  constexpr Bounds unitCube{ 0, 1, 0, 1, 0, 1 }; // so that position and scale are those of the box
  vtkSMPropertyHelper(box, "UseReferenceBounds").Set(1);
  vtkSMPropertyHelper(box, "ReferenceBounds").Set(unitCube.data(), 6);
  vtkSMPropertyHelper(box, "RotationEnabled").Set(0);
  box->UpdateVTKObjects();

  setDataSource(vtkSMPropertyHelper(proxy, "Input").GetAsProxy());
  makeFields(group->GetProperty("Region"));
  connect(this, &pqInteractivePropertyWidgetAbstract::interaction, this,
    &pqRegionPropertyWidget::takeBox);
  connect(this, &pqInteractivePropertyWidgetAbstract::endInteraction, this,
    &pqRegionPropertyWidget::takeBox);
  placeWidget();
}

pqRegionPropertyWidget::~pqRegionPropertyWidget() = default;

void pqRegionPropertyWidget::makeFields(vtkSMProperty* region)
{
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(2);
  const QString help = getTooltip(region);
  for (int i = 0; i < 6; ++i)
  {
    const int axis = i / 2;
    if (i % 2 == 0)
    {
      layout->addWidget(new QLabel(QString("XYZ").mid(axis, 1), this), axis, 0);
    }
    fields_[i] = new pqDoubleLineEdit(this);
    fields_[i]->setObjectName(QString("Bound%1").arg(i));
    fields_[i]->setToolTip(help);
    layout->addWidget(fields_[i], axis, 1 + i % 2);
    addPropertyLink(fields_[i], "text2", SIGNAL(textChangedAndEditingFinished()), region, i);
    connect(fields_[i], &QLineEdit::textChanged, this, &pqRegionPropertyWidget::placeWidget);
  }
  auto* show = new QCheckBox("Show Box", this);
  show->setObjectName("ShowBox");
  show->setToolTip("Show the region as a box in the view; drag its faces. Default on.");
  show->setChecked(true);
  connect(show, &QCheckBox::toggled, this, &pqRegionPropertyWidget::setWidgetVisible);
  connect(this, &pqInteractivePropertyWidgetAbstract::widgetVisibilityToggled, show,
    &QCheckBox::setChecked);
  layout->addWidget(show, 3, 0, 1, 2);
  auto* reset = new QPushButton("Bounds of Mesh", this);
  reset->setObjectName("BoundsOfMesh");
  reset->setToolTip("Set the region to the bounds of the mesh.");
  connect(reset, &QPushButton::clicked, this, &pqRegionPropertyWidget::takeDataBounds);
  layout->addWidget(reset, 3, 2);
}

pqRegionPropertyWidget::Bounds pqRegionPropertyWidget::bounds() const
{
  Bounds result{};
  std::transform(fields_.begin(), fields_.end(), result.begin(),
    [](const pqDoubleLineEdit* field) { return field->text().toDouble(); });
  return result;
}

void pqRegionPropertyWidget::setBounds(const Bounds& bounds)
{
  for (int i = 0; i < 6; ++i)
  {
    fields_[i]->setTextAndResetCursor(
      QString::number(bounds[i], 'g', QLocale::FloatingPointShortest));
  }
}

/// Puts the box to where the fields say.
void pqRegionPropertyWidget::placeWidget()
{
  if (dragging_)
  {
    return;
  }
  const Bounds box = drawn(bounds());
  const std::array<double, 3> corner{ box[0], box[2], box[4] };
  const std::array<double, 3> size{ box[1] - box[0], box[3] - box[2], box[5] - box[4] };
  vtkSMPropertyHelper(widgetProxy(), "Position").Set(corner.data(), 3);
  vtkSMPropertyHelper(widgetProxy(), "Scale").Set(size.data(), 3);
  widgetProxy()->UpdateVTKObjects();
  render();
}

/// Puts the numbers of the dragged box into the fields.
void pqRegionPropertyWidget::takeBox()
{
  std::array<double, 3> corner{};
  std::array<double, 3> size{};
  vtkSMPropertyHelper(widgetProxy(), "Position").Get(corner.data(), 3);
  vtkSMPropertyHelper(widgetProxy(), "Scale").Get(size.data(), 3);
  Bounds region = bounds();
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!isFlat(region, axis)) // a face may have been dragged through the other one
    {
      const double other = corner[axis] + size[axis];
      region[2 * axis] = std::min(corner[axis], other);
      region[2 * axis + 1] = std::max(corner[axis], other);
    }
  }
  dragging_ = true;
  setBounds(region);
  dragging_ = false;
  Q_EMIT changeAvailable();
}

void pqRegionPropertyWidget::takeDataBounds()
{
  const vtkBoundingBox box = dataBounds();
  if (box.IsValid())
  {
    Bounds region{};
    box.GetBounds(region.data());
    setBounds(region);
    Q_EMIT changeAvailable();
    Q_EMIT changeFinished();
  }
}
