# Names the session to the browser, and says to each of its calls (ICustomTabsCallback) that all is well.
.class public Lcampus/mail/SessionCallback;
.super Landroid/os/Binder;

.method public constructor <init>()V
    .registers 1
    invoke-direct {p0}, Landroid/os/Binder;-><init>()V
    return-void
.end method

.method protected onTransact(ILandroid/os/Parcel;Landroid/os/Parcel;I)Z
    .registers 6
    # One-way calls have no reply.
    if-eqz p3, :done
    invoke-virtual {p3}, Landroid/os/Parcel;->writeNoException()V
    :done
    const/4 v0, 0x1
    return v0
.end method
