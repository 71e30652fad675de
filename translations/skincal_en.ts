<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="en" sourcelanguage="en">
<context>
    <name>BoardWords</name>
    <message numerus="yes">
        <source>%n boards, better %1</source>
        <translation>
            <numerusform>%n board, better %1</numerusform>
            <numerusform>%n boards, better %1</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>LensWords</name>
    <message numerus="yes">
        <source>calibrated from %n boards, rms %1 px</source>
        <translation>
            <numerusform>calibrated from %n board, rms %1 px</numerusform>
            <numerusform>calibrated from %n boards, rms %1 px</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>skincal::CalibrationDialog</name>
    <message numerus="yes">
        <source>%n boards</source>
        <translation>
            <numerusform>%n board</numerusform>
            <numerusform>%n boards</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>skincal::ConnectPage</name>
    <message numerus="yes">
        <source>Not connected; %n modules are known</source>
        <translation>
            <numerusform>Not connected; %n module is known</numerusform>
            <numerusform>Not connected; %n modules are known</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Exploring: %n modules found</source>
        <translation>
            <numerusform>Exploring: %n module found</numerusform>
            <numerusform>Exploring: %n modules found</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n modules, </source>
        <translation>
            <numerusform>%n module, </numerusform>
            <numerusform>%n modules, </numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n links</source>
        <translation>
            <numerusform>%n link</numerusform>
            <numerusform>%n links</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>skincal::ConnectPresenter</name>
    <message numerus="yes">
        <source>The network went silent after %n modules had reported</source>
        <translation>
            <numerusform>The network went silent after %n module had reported</numerusform>
            <numerusform>The network went silent after %n modules had reported</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>skincal::DetectionModel</name>
    <message numerus="yes">
        <source>Reject %n detections in %1</source>
        <translation>
            <numerusform>Reject %n detection in %1</numerusform>
            <numerusform>Reject %n detections in %1</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Accept %n detections in %1</source>
        <translation>
            <numerusform>Accept %n detection in %1</numerusform>
            <numerusform>Accept %n detections in %1</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>skincal::MeshPresenter</name>
    <message numerus="yes">
        <source>%n modules have no surface near that faces their way.</source>
        <translation>
            <numerusform>%n module has no surface near that faces its way.</numerusform>
            <numerusform>%n modules have no surface near that faces their way.</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>skincal::OverlapGraph</name>
    <message numerus="yes">
        <source>patch %1
%n modules</source>
        <translation>
            <numerusform>patch %1
%n module</numerusform>
            <numerusform>patch %1
%n modules</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>skincal::PicturePanel</name>
    <message numerus="yes">
        <source>%n spots count: %1 px rms, %2 px median, worst %3 px (module %4)</source>
        <translation>
            <numerusform>%n spot counts: %1 px rms, %2 px median, worst %3 px (module %4)</numerusform>
            <numerusform>%n spots count: %1 px rms, %2 px median, worst %3 px (module %4)</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>skincal::ProblemModel</name>
    <message numerus="yes">
        <source>%n modules did not answer: %1</source>
        <translation>
            <numerusform>%n module did not answer: %1</numerusform>
            <numerusform>%n modules did not answer: %1</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n modules that were there do not answer any more: %1. Connect again to go on without them</source>
        <translation>
            <numerusform>%n module that was there does not answer any more: %1. Connect again to go on without it</numerusform>
            <numerusform>%n modules that were there do not answer any more: %1. Connect again to go on without them</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n modules have come that were not there before. Connect again to take them in</source>
        <translation>
            <numerusform>%n module has come that was not there before. Connect again to take it in</numerusform>
            <numerusform>%n modules have come that were not there before. Connect again to take them in</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>%n modules did not show the last light they were told to: %1</source>
        <translation>
            <numerusform>%n module did not show the last light it was told to: %1</numerusform>
            <numerusform>%n modules did not show the last light they were told to: %1</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>skincal::ScanPage</name>
    <message numerus="yes">
        <source>, %n spots</source>
        <translation>
            <numerusform>, %n spot</numerusform>
            <numerusform>, %n spots</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Ready: %n pictures of this view will be taken.</source>
        <translation>
            <numerusform>Ready: %n picture of this view will be taken.</numerusform>
            <numerusform>Ready: %n pictures of this view will be taken.</numerusform>
        </translation>
    </message>
    <message numerus="yes">
        <source>Looking again for %n modules</source>
        <translation>
            <numerusform>Looking again for %n module</numerusform>
            <numerusform>Looking again for %n modules</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>skincal::ScanPresenter</name>
    <message numerus="yes">
        <source>One at a time that is %n pictures, more than fit into the memory: scan by words.</source>
        <translation>
            <numerusform>One at a time that is %n picture, more than fits into the memory: scan by words.</numerusform>
            <numerusform>One at a time that is %n pictures, more than fit into the memory: scan by words.</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>skincal::ViewsPresenter</name>
    <message numerus="yes">
        <source>%n patches are not placed yet.</source>
        <translation>
            <numerusform>%n patch is not placed yet.</numerusform>
            <numerusform>%n patches are not placed yet.</numerusform>
        </translation>
    </message>
</context>
</TS>
