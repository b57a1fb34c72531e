# Opens the pages as a Trusted Web Activity: full screen, in a browser that offers a Custom Tabs session for them.
# Assembler, since Debian has one for Android's byte code (smali) but neither a dexer nor android.jar.
# ${host} is filled in by __main__.py. "p0" is this activity.
.class public Lcampus/mail/Launcher;
.super Landroid/app/Activity;
.implements Landroid/content/ServiceConnection;

# The package of the browser whose service was bound, or null.
.field private browser:Ljava/lang/String;
# Set once the pages were opened: the system connects again after a crash of the browser.
.field private opened:Z

.method public constructor <init>()V
    .registers 1
    invoke-direct {p0}, Landroid/app/Activity;-><init>()V
    return-void
.end method

# Binds the Custom Tabs service of the default browser, else of any that supports Trusted Web Activities.
.method protected onCreate(Landroid/os/Bundle;)V
    .registers 8
    invoke-super {p0, p1}, Landroid/app/Activity;->onCreate(Landroid/os/Bundle;)V
    # A saved state: the system ended this app behind its pages, and the user left them by "back".
    if-eqz p1, :first
    invoke-virtual {p0}, Lcampus/mail/Launcher;->finish()V
    return-void

    :first
    invoke-virtual {p0}, Lcampus/mail/Launcher;->getPackageManager()Landroid/content/pm/PackageManager;
    move-result-object v0
    new-instance v1, Landroid/content/Intent;
    const-string v2, "android.support.customtabs.action.CustomTabsService"
    invoke-direct {v1, v2}, Landroid/content/Intent;-><init>(Ljava/lang/String;)V
    const-string v2, "androidx.browser.trusted.category.TrustedWebActivities"
    invoke-virtual {v1, v2}, Landroid/content/Intent;->addCategory(Ljava/lang/String;)Landroid/content/Intent;

    invoke-static {}, Lcampus/mail/Launcher;->anyPage()Landroid/content/Intent;
    move-result-object v2
    const/high16 v3, 0x10000  # PackageManager.MATCH_DEFAULT_ONLY
    invoke-virtual {v0, v2, v3}, Landroid/content/pm/PackageManager;->resolveActivity(Landroid/content/Intent;I)Landroid/content/pm/ResolveInfo;
    move-result-object v2
    if-eqz v2, :any
    iget-object v2, v2, Landroid/content/pm/ResolveInfo;->activityInfo:Landroid/content/pm/ActivityInfo;
    iget-object v2, v2, Landroid/content/pm/ActivityInfo;->packageName:Ljava/lang/String;
    invoke-virtual {v1, v2}, Landroid/content/Intent;->setPackage(Ljava/lang/String;)Landroid/content/Intent;
    const/4 v3, 0x0
    invoke-virtual {v0, v1, v3}, Landroid/content/pm/PackageManager;->resolveService(Landroid/content/Intent;I)Landroid/content/pm/ResolveInfo;
    move-result-object v2
    if-nez v2, :bind

    :any
    const/4 v3, 0x0
    invoke-virtual {v1, v3}, Landroid/content/Intent;->setPackage(Ljava/lang/String;)Landroid/content/Intent;
    invoke-virtual {v0, v1, v3}, Landroid/content/pm/PackageManager;->resolveService(Landroid/content/Intent;I)Landroid/content/pm/ResolveInfo;
    move-result-object v2
    if-eqz v2, :plain

    :bind
    iget-object v2, v2, Landroid/content/pm/ResolveInfo;->serviceInfo:Landroid/content/pm/ServiceInfo;
    iget-object v2, v2, Landroid/content/pm/ServiceInfo;->packageName:Ljava/lang/String;
    iput-object v2, p0, Lcampus/mail/Launcher;->browser:Ljava/lang/String;
    invoke-virtual {v1, v2}, Landroid/content/Intent;->setPackage(Ljava/lang/String;)Landroid/content/Intent;
    const/4 v3, 0x1  # Context.BIND_AUTO_CREATE
    invoke-virtual {p0, v1, p0, v3}, Lcampus/mail/Launcher;->bindService(Landroid/content/Intent;Landroid/content/ServiceConnection;I)Z
    move-result v3
    if-nez v3, :connecting

    :plain
    const/4 v3, 0x0
    invoke-direct {p0, v3}, Lcampus/mail/Launcher;->open(Landroid/os/IBinder;)V
    :connecting
    return-void
.end method

# Asks the browser for a session. By it the browser knows this app, and checks the host's assetlinks.json against it.
.method public onServiceConnected(Landroid/content/ComponentName;Landroid/os/IBinder;)V
    .registers 9
    new-instance v0, Lcampus/mail/SessionCallback;
    invoke-direct {v0}, Lcampus/mail/SessionCallback;-><init>()V
    invoke-static {}, Landroid/os/Parcel;->obtain()Landroid/os/Parcel;
    move-result-object v1
    invoke-static {}, Landroid/os/Parcel;->obtain()Landroid/os/Parcel;
    move-result-object v2
    :try_start
    const-string v3, "android.support.customtabs.ICustomTabsService"
    invoke-virtual {v1, v3}, Landroid/os/Parcel;->writeInterfaceToken(Ljava/lang/String;)V
    invoke-virtual {v1, v0}, Landroid/os/Parcel;->writeStrongBinder(Landroid/os/IBinder;)V
    const/4 v3, 0x3  # boolean newSession(ICustomTabsCallback)
    const/4 v4, 0x0
    invoke-interface {p2, v3, v1, v2, v4}, Landroid/os/IBinder;->transact(ILandroid/os/Parcel;Landroid/os/Parcel;I)Z
    invoke-virtual {v2}, Landroid/os/Parcel;->readException()V
    invoke-virtual {v2}, Landroid/os/Parcel;->readInt()I
    move-result v3
    :try_end
    .catch Ljava/lang/Exception; {:try_start .. :try_end} :refused
    if-nez v3, :open
    goto :no_session

    :refused
    move-exception v3
    :no_session
    const/4 v0, 0x0
    :open
    invoke-virtual {v1}, Landroid/os/Parcel;->recycle()V
    invoke-virtual {v2}, Landroid/os/Parcel;->recycle()V
    invoke-direct {p0, v0}, Lcampus/mail/Launcher;->open(Landroid/os/IBinder;)V
    return-void
.end method

# The browser has the service but hands out nothing.
.method public onNullBinding(Landroid/content/ComponentName;)V
    .registers 3
    const/4 v0, 0x0
    invoke-direct {p0, v0}, Lcampus/mail/Launcher;->open(Landroid/os/IBinder;)V
    return-void
.end method

.method public onServiceDisconnected(Landroid/content/ComponentName;)V
    .registers 2
    return-void
.end method

# Opens the page that was asked for, or the first: with a session full screen, without one as any page in the browser.
.method private open(Landroid/os/IBinder;)V
    .registers 7
    iget-boolean v0, p0, Lcampus/mail/Launcher;->opened:Z
    if-eqz v0, :first
    return-void
    :first
    const/4 v0, 0x1
    iput-boolean v0, p0, Lcampus/mail/Launcher;->opened:Z

    # Other apps can start this one with any address: only those of the host are opened.
    const-string v1, "https://${host}/"
    invoke-virtual {p0}, Lcampus/mail/Launcher;->getIntent()Landroid/content/Intent;
    move-result-object v2
    invoke-virtual {v2}, Landroid/content/Intent;->getDataString()Ljava/lang/String;
    move-result-object v2
    if-eqz v2, :page
    invoke-virtual {v2, v1}, Ljava/lang/String;->startsWith(Ljava/lang/String;)Z
    move-result v3
    if-eqz v3, :page
    move-object v1, v2
    :page
    invoke-static {v1}, Landroid/net/Uri;->parse(Ljava/lang/String;)Landroid/net/Uri;
    move-result-object v1
    new-instance v2, Landroid/content/Intent;
    const-string v3, "android.intent.action.VIEW"
    invoke-direct {v2, v3, v1}, Landroid/content/Intent;-><init>(Ljava/lang/String;Landroid/net/Uri;)V
    if-eqz p1, :plain

    iget-object v1, p0, Lcampus/mail/Launcher;->browser:Ljava/lang/String;
    invoke-virtual {v2, v1}, Landroid/content/Intent;->setPackage(Ljava/lang/String;)Landroid/content/Intent;
    new-instance v1, Landroid/os/Bundle;
    invoke-direct {v1}, Landroid/os/Bundle;-><init>()V
    const-string v3, "android.support.customtabs.extra.SESSION"
    invoke-virtual {v1, v3, p1}, Landroid/os/Bundle;->putBinder(Ljava/lang/String;Landroid/os/IBinder;)V
    const-string v3, "android.support.customtabs.extra.LAUNCH_AS_TRUSTED_WEB_ACTIVITY"
    invoke-virtual {v1, v3, v0}, Landroid/os/Bundle;->putBoolean(Ljava/lang/String;Z)V
    invoke-virtual {v2, v1}, Landroid/content/Intent;->putExtras(Landroid/os/Bundle;)Landroid/content/Intent;
    # It stays behind the pages, for the session lasts as long as this process.
    invoke-virtual {p0, v2}, Lcampus/mail/Launcher;->startActivity(Landroid/content/Intent;)V
    return-void

    :plain
    # This app opens links to the host itself: the selector leaves browsers alone to choose from.
    invoke-static {}, Lcampus/mail/Launcher;->anyPage()Landroid/content/Intent;
    move-result-object v1
    invoke-virtual {v2, v1}, Landroid/content/Intent;->setSelector(Landroid/content/Intent;)V
    invoke-virtual {p0, v2}, Lcampus/mail/Launcher;->startActivity(Landroid/content/Intent;)V
    invoke-virtual {p0}, Lcampus/mail/Launcher;->finish()V
    return-void
.end method

# An intent that every browser answers and no app of a single host.
.method private static anyPage()Landroid/content/Intent;
    .registers 3
    const-string v0, "http://"
    invoke-static {v0}, Landroid/net/Uri;->parse(Ljava/lang/String;)Landroid/net/Uri;
    move-result-object v0
    new-instance v1, Landroid/content/Intent;
    const-string v2, "android.intent.action.VIEW"
    invoke-direct {v1, v2, v0}, Landroid/content/Intent;-><init>(Ljava/lang/String;Landroid/net/Uri;)V
    const-string v0, "android.intent.category.BROWSABLE"
    invoke-virtual {v1, v0}, Landroid/content/Intent;->addCategory(Ljava/lang/String;)Landroid/content/Intent;
    return-object v1
.end method

# The user left the pages by "back".
.method protected onRestart()V
    .registers 1
    invoke-super {p0}, Landroid/app/Activity;->onRestart()V
    invoke-virtual {p0}, Lcampus/mail/Launcher;->finish()V
    return-void
.end method

.method protected onDestroy()V
    .registers 2
    iget-object v0, p0, Lcampus/mail/Launcher;->browser:Ljava/lang/String;
    if-eqz v0, :unbound
    invoke-virtual {p0, p0}, Lcampus/mail/Launcher;->unbindService(Landroid/content/ServiceConnection;)V
    :unbound
    invoke-super {p0}, Landroid/app/Activity;->onDestroy()V
    return-void
.end method
