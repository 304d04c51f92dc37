#include "pqReaderChoice.h"

#include <QChildEvent>
#include <QDialog>
#include <QListWidget>
#include <QTimer>
#include <pqCoreUtilities.h>

namespace
{

/// The readers of a file are few, and all readers many.
constexpr int MostReaders = 4;

/// Chooses Mesh Reader in the dialog that asks for a reader; false where it is another dialog.
bool chooseMeshReader(const QDialog* dialog)
{
  auto* list = dialog->findChild<QListWidget*>("listWidget");
  if (!dialog->inherits("pqSelectReaderDialog") || !list || list->count() > MostReaders)
  {
    return false;
  }
  for (int row = 0; row < list->count(); ++row)
  {
    if (list->item(row)->data(Qt::UserRole + 1).toString() == "AMeshReader")
    {
      list->setCurrentRow(row);
      return true;
    }
  }
  return false;
}

} // namespace

pqReaderChoice::pqReaderChoice(QObject* parent) : QObject(parent) {}

void pqReaderChoice::startup()
{
  if (QWidget* window = pqCoreUtilities::mainWidget())
  {
    window->installEventFilter(this);
  }
}

void pqReaderChoice::shutdown()
{
  if (QWidget* window = pqCoreUtilities::mainWidget())
  {
    window->removeEventFilter(this);
  }
}

bool pqReaderChoice::eventFilter(QObject* window, QEvent* event)
{
  if (event->type() == QEvent::ChildAdded)
  {
    // What it is, is known once it is made: when its own loop of events runs.
    QObject* child = static_cast<QChildEvent*>(event)->child();
    QTimer::singleShot(0, child,
      [child]
      {
        auto* dialog = qobject_cast<QDialog*>(child);
        if (dialog && chooseMeshReader(dialog))
        {
          dialog->accept();
        }
      });
  }
  return QObject::eventFilter(window, event);
}
