#include "pqAdaptationAbort.h"

#include <QApplication>
#include <QMouseEvent>
#include <QWidget>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqPipelineSource.h>
#include <pqProgressManager.h>
#include <pqServerManagerModel.h>
#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkSMProxy.h>

#include <string>

namespace
{

pqProgressManager* progressManager()
{
  return pqApplicationCore::instance()->getProgressManager();
}

QWidget* abortButton()
{
  QWidget* window = pqCoreUtilities::mainWidget();
  return window ? window->findChild<QWidget*>("AbortButton") : nullptr;
}

bool isOnAbortButton(const QMouseEvent* event)
{
  const QWidget* button = abortButton();
  return button && button->rect().contains(button->mapFromGlobal(event->globalPos()));
}

} // namespace

pqAdaptationAbort::pqAdaptationAbort(QObject* parent) : QObject(parent) {}

void pqAdaptationAbort::startup()
{
  connect(pqApplicationCore::instance()->getServerManagerModel(),
    &pqServerManagerModel::sourceAdded, this, &pqAdaptationAbort::watch);
  connect(progressManager(), &pqProgressManager::abort, this, &pqAdaptationAbort::abort);
}

void pqAdaptationAbort::shutdown()
{
  disconnect(pqApplicationCore::instance()->getServerManagerModel(), nullptr, this, nullptr);
  disconnect(progressManager(), nullptr, this, nullptr);
}

void pqAdaptationAbort::watch(pqPipelineSource* source)
{
  auto* filter = vtkAlgorithm::SafeDownCast(source->getProxy()->GetClientSideObject());
  if (filter && std::string(source->getProxy()->GetXMLName()) == "AdaptToCAD")
  {
    filter->AddObserver(vtkCommand::StartEvent, this, &pqAdaptationAbort::begin);
    filter->AddObserver(vtkCommand::ProgressEvent, this, &pqAdaptationAbort::look);
    filter->AddObserver(vtkCommand::EndEvent, this, &pqAdaptationAbort::end);
  }
}

void pqAdaptationAbort::begin(vtkObject* filter, unsigned long, void*)
{
  running_ = vtkAlgorithm::SafeDownCast(filter);
  progressManager()->setEnableAbort(true);
}

void pqAdaptationAbort::look(vtkObject*, unsigned long, void*)
{
  if (!running_)
  {
    return;
  }
  const bool wereUnblocked = progressManager()->unblockEvents(true);
  QApplication::instance()->installEventFilter(this);
  QApplication::processEvents();
  QApplication::instance()->removeEventFilter(this);
  progressManager()->unblockEvents(wereUnblocked);
}

void pqAdaptationAbort::end(vtkObject*, unsigned long, void*)
{
  running_ = nullptr;
  progressManager()->setEnableAbort(false);
}

void pqAdaptationAbort::abort()
{
  if (running_)
  {
    running_->SetAbortExecute(1);
  }
}

bool pqAdaptationAbort::eventFilter(QObject*, QEvent* event)
{
  switch (event->type())
  {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseMove:
      return !isOnAbortButton(static_cast<QMouseEvent*>(event));
    case QEvent::MouseButtonDblClick:
    case QEvent::Wheel:
    case QEvent::KeyPress:
    case QEvent::KeyRelease:
    case QEvent::Shortcut:
    case QEvent::ShortcutOverride:
    case QEvent::ContextMenu:
    case QEvent::Close:
    case QEvent::Timer: // comes again; it might render, and so run the filter that is running
      return true;
    default:
      return false;
  }
}
