; The installer of Brushwork for one user: no administrator is needed. VERSION, FILES (a folder) and OUTPUT come from app/packaging/run.
; Silently: brushwork-VERSION-setup.exe /S [/D=C:\Folder]. Profiles, backups and settings of the user are never touched.
Target amd64-unicode
ManifestDPIAware true
!include "MUI2.nsh"
!include "FileFunc.nsh"

Name "Brushwork ${VERSION}"
OutFile "${OUTPUT}"
RequestExecutionLevel user
InstallDir "$LOCALAPPDATA\Programs\Brushwork"
InstallDirRegKey HKCU "Software\Brushwork" "Folder"
SetCompressor /SOLID lzma

!define UNINSTALL "Software\Microsoft\Windows\CurrentVersion\Uninstall\Brushwork"
!define MUI_ICON "${FILES}\brushwork.ico"
!define MUI_UNICON "${FILES}\brushwork.ico"
!define MUI_FINISHPAGE_RUN "$INSTDIR\brushwork-window.exe"
!define MUI_FINISHPAGE_RUN_PARAMETERS "--open sim:mcp266"
!define MUI_FINISHPAGE_RUN_TEXT "Open Brushwork with a simulated controller"

!insertmacro MUI_PAGE_WELCOME
!insertmacro MUI_PAGE_LICENSE "${FILES}\LICENSE-MIT.txt"
!insertmacro MUI_PAGE_DIRECTORY
!insertmacro MUI_PAGE_INSTFILES
!insertmacro MUI_PAGE_FINISH
!insertmacro MUI_UNPAGE_CONFIRM
!insertmacro MUI_UNPAGE_INSTFILES
!insertmacro MUI_LANGUAGE "English"

Section
    SetOutPath "$INSTDIR"
    File "${FILES}\*.*"
    WriteUninstaller "$INSTDIR\uninstall.exe"

    CreateDirectory "$SMPROGRAMS\Brushwork"
    CreateShortcut "$SMPROGRAMS\Brushwork\Brushwork.lnk" "$INSTDIR\brushwork-window.exe" "" "$INSTDIR\brushwork.ico"
    CreateShortcut "$SMPROGRAMS\Brushwork\Brushwork with a simulated controller.lnk" "$INSTDIR\brushwork-window.exe" "--open sim:mcp266" "$INSTDIR\brushwork.ico"
    CreateShortcut "$SMPROGRAMS\Brushwork\Brushwork command line.lnk" "$SYSDIR\cmd.exe" '/k "set PATH=$INSTDIR;%PATH%&& brushwork --help"' "$INSTDIR\brushwork.ico"

    WriteRegStr HKCU "Software\Brushwork" "Folder" "$INSTDIR"
    WriteRegStr HKCU "Software\Microsoft\Windows\CurrentVersion\App Paths\brushwork.exe" "" "$INSTDIR\brushwork.exe"
    WriteRegStr HKCU "${UNINSTALL}" "DisplayName" "Brushwork"
    WriteRegStr HKCU "${UNINSTALL}" "DisplayVersion" "${VERSION}"
    WriteRegStr HKCU "${UNINSTALL}" "DisplayIcon" "$INSTDIR\brushwork.ico"
    WriteRegStr HKCU "${UNINSTALL}" "Publisher" "The Brushwork authors"
    WriteRegStr HKCU "${UNINSTALL}" "InstallLocation" "$INSTDIR"
    WriteRegStr HKCU "${UNINSTALL}" "UninstallString" '"$INSTDIR\uninstall.exe"'
    WriteRegStr HKCU "${UNINSTALL}" "QuietUninstallString" '"$INSTDIR\uninstall.exe" /S'
    WriteRegDWORD HKCU "${UNINSTALL}" "NoModify" 1
    WriteRegDWORD HKCU "${UNINSTALL}" "NoRepair" 1
    ${GetSize} "$INSTDIR" "/S=0K" $0 $1 $2
    IntFmt $0 "0x%08X" $0
    WriteRegDWORD HKCU "${UNINSTALL}" "EstimatedSize" "$0"
SectionEnd

; Only what was installed goes: a file that somebody put into the folder stays, and so does the folder then.
Section "Uninstall"
    Delete "$INSTDIR\brushwork.exe"
    Delete "$INSTDIR\brushwork-window.exe"
    Delete "$INSTDIR\brushwork.ico"
    Delete "$INSTDIR\brushwork.ps1"
    Delete "$INSTDIR\README.txt"
    Delete "$INSTDIR\CHANGELOG.txt"
    Delete "$INSTDIR\SAFETY.txt"
    Delete "$INSTDIR\LICENSE-APACHE.txt"
    Delete "$INSTDIR\LICENSE-MIT.txt"
    Delete "$INSTDIR\uninstall.exe"
    RMDir "$INSTDIR"
    Delete "$SMPROGRAMS\Brushwork\*.lnk"
    RMDir "$SMPROGRAMS\Brushwork"
    DeleteRegKey HKCU "${UNINSTALL}"
    DeleteRegKey HKCU "Software\Microsoft\Windows\CurrentVersion\App Paths\brushwork.exe"
    DeleteRegKey HKCU "Software\Brushwork"
SectionEnd
